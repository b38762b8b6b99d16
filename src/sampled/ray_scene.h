// The scene as Embree sees it: single precision, in the unit box.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "sampled/sample_points.h"

namespace exactff::sampled {

// The move and power-of-two scale that bring the scene's pieces into the unit box.
struct UnitBox {
  Vec3 centre;
  double scale = 1.0;

  // In scaled coordinates: of two points closer than this, single precision cannot be trusted to say which is in
  // front. 2^-18 of the box, well above the 2^-22 that rounding both ends of a ray can add up to.
  [[nodiscard]] double blur() const { return 0x1p-18 / scale; }
};

// The pieces that stop rays; rays pass through all others.
class Blockers {
 public:
  void assign(std::size_t piece_count, std::span<const std::uint32_t> pieces);
  void assign_all_but(std::size_t piece_count, std::span<const std::uint32_t> pieces);
  [[nodiscard]] bool contains(std::uint32_t piece) const { return (named_[piece] != 0) != all_but_; }

 private:
  void name(std::size_t piece_count, std::span<const std::uint32_t> pieces);

  std::vector<std::uint8_t> named_;
  std::vector<std::uint32_t> pieces_;
  bool all_but_ = false;
};

// Throws InputError where rounding to single precision merges vertices or collapses or flips a piece. `points` are the
// scene's vertices, scaled to about 1.
[[nodiscard]] UnitBox checked_unit_box(const Scene& scene, const std::vector<Vec3>& points);

// Immutable; safe to use from several threads at once.
class RayScene {
 public:
  RayScene(const Scene& scene, const std::vector<Vec3>& points, const UnitBox& box);

  static constexpr int kPacket = 16;
  // Bit k: the ray from `origin` (a scaled point) to end first + k is hidden by a blocker, for k < kPacket. Bits of
  // `hidden` are taken over, not asked.
  [[nodiscard]] unsigned hidden_lanes(const Vec3& origin, const RayEnds& ends, int first, const Blockers& blockers,
                                      unsigned hidden) const;

 private:
  struct DeviceRelease {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  struct SceneRelease {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };

  void add_mesh(const Scene& scene, const std::vector<Vec3>& points);

  UnitBox box_;
  std::vector<std::uint32_t> piece_of_triangle_;
  std::unique_ptr<RTCDeviceTy, DeviceRelease> device_;
  std::unique_ptr<RTCSceneTy, SceneRelease> scene_;
};

}  // namespace exactff::sampled
