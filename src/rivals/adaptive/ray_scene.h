// The scene in the form that Embree takes: single precision, in the unit box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adaptive/sample_points.h"
#include "exactff/scene.h"

// Embree's types (adaptive/embree.h)
struct RTCDeviceTy;
struct RTCSceneTy;

namespace exactff::adaptive {

// Scenes with at most this many pieces never need Embree: their lists of occluders are short and tested in double.
inline constexpr std::size_t kMostPiecesWithoutEmbree = 16;

// The smallest coordinate except for 0 that is passed to Embree, in the unit box.
//
// Embree's builder flushes subnormal floats to 0. Floats that are 0 or at least 2^-103 differ by 0 or at least 2^-126,
// the smallest normal float: no difference of corners is lost, and no two corners compare as different but have
// difference 0. Such corners would fail an assertion in the builder's triangle splitter (Debian's build enables
// assertions). 2^-100 leaves a margin of 2^3.
inline constexpr double kLeastInEmbree = 0x1p-100;

// The translation and power-of-two scale that bring the scene's pieces into the unit box.
struct UnitBox {
  Vec3 centre;
  double scale = 1.0;
  double least = 0.0;  // smaller coordinates in the box become 0

  // In scaled coordinates: single precision cannot reliably decide which of two points closer than this is in front.
  // 2^-18 of the box, well above the 2^-22 that rounding both ends of a ray can cause.
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

// Throws InputError if rounding to single precision merges vertices or collapses or flips a piece. `points` are the
// scene's vertices, scaled to about 1.
//
// In a scene that may need Embree, coordinates below kLeastInEmbree in the box become 0. Throws InputError if that
// moves a vertex by more than 2^-24 of the scene's half extent along the axis, which is more than single precision
// moves the outermost vertices: a scene that is thinner than 2^-75 (2.6e-23) of its size along some axis may be
// refused, and one thinner than 2^-99 (1.6e-30), but not flat, is.
[[nodiscard]] UnitBox checked_unit_box(const Scene& scene, const std::vector<Vec3>& points);

// Immutable; safe to use from several threads at once.
class RayScene {
 public:
  RayScene(const Scene& scene, const std::vector<Vec3>& points, const UnitBox& box);

  static constexpr int kPacket = 16;
  // Bit k: the ray from `origin` (a scaled point) to end first + k is hidden by a blocker, for k < kPacket. Bits set in
  // `hidden` are copied to the result; their rays are not traced.
  [[nodiscard]] unsigned hidden_lanes(const Vec3& origin, const RayEnds& ends, int first, const Blockers& blockers,
                                      unsigned hidden) const;

 private:
  struct DeviceRelease {
    void operator()(RTCDeviceTy* device) const;
  };
  struct SceneRelease {
    void operator()(RTCSceneTy* scene) const;
  };

  void add_mesh(const Scene& scene, const std::vector<Vec3>& points);

  UnitBox box_;
  std::vector<std::uint32_t> piece_of_triangle_;
  std::unique_ptr<RTCDeviceTy, DeviceRelease> device_;
  std::unique_ptr<RTCSceneTy, SceneRelease> scene_;
};

}  // namespace exactff::adaptive
