// A scene prepared for shadow rays, shared by all methods that trace rays.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>

#include "adaptive/ray_scene.h"
#include "adaptive/receiver_view.h"

namespace exactff::adaptive {

// Embree is used for longer lists. Measured for 16 rays: a candidate costs 25 ns, a packet of rays 1 to 6 us in scenes
// of 100 to 10,000 triangles, so that both cost the same at 50 (blinds) to 300 (soup).
inline constexpr std::size_t kLongestDirectList = 128;

// Beyond this distance, in sizes of the scene, products of lengths might overflow; F is below 2^-400 there.
inline constexpr double kFarthest = 0x1p200;

struct SampledScene {
  // Throws InputError if single precision would distort the scene (see checked_unit_box).
  explicit SampledScene(const Scene& given) : scene(given), unit_box(checked_unit_box(given, scene.points)) {}

  // Built at the first call.
  const RayScene& ray_scene() const {
    std::call_once(rays_built, [this] {
      const auto start = std::chrono::steady_clock::now();
      rays.emplace(*scene.scene, scene.points, unit_box);
      build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    });
    return *rays;
  }

  ScaledScene scene;
  UnitBox unit_box;
  mutable std::once_flag rays_built;
  mutable std::optional<RayScene> rays;
  mutable std::atomic<double> build_seconds = 0.0;
};

}  // namespace exactff::adaptive
