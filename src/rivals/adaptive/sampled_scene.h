// A scene prepared for shadow rays, shared by all methods that trace rays: for Embree, and for each receiver.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "adaptive/shaft.h"
#include "adaptive/sub_patch.h"
#include "exactff/adaptive.h"
#include "exactff/scene.h"
#include "kernel/expect.h"
#include "receivers/own_pieces.h"
#include "scene/shaft_tree.h"

// --- The scene in the form that Embree takes: single precision, in the unit box ---

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

// --- Receiver view ---

// One receiver's view of a scene: which planes face it, and which pieces may lie between it and a source.

// The scene in coordinates multiplied by the power of two that brings the largest into [1/2, 1). Products of a few
// lengths then neither overflow nor underflow, for any unit of length.
struct ScaledScene {
  const Scene* scene = nullptr;
  double scale = 1.0;
  std::vector<Vec3> points;
  ShaftTree tree;  // over the boxes of the pieces

  explicit ScaledScene(const Scene& scene);
};

// The box around these points.
[[nodiscard]] Box bounds_of(const std::vector<Vec3>& points, std::span<const std::uint32_t> indices);

struct ReceiverView {
  Vec3 exact_point;  // as given
  Vec3 point;        // scaled
  Vec3 normal;       // times a power of two
  Vec3 unit_normal;
  OwnPieces own;  // neither occlude nor illuminate

  [[nodiscard]] bool is_own(std::uint32_t piece) const { return own.contains(piece); }
};

// Throws InputError if a coordinate is not finite or the normal is zero, std::invalid_argument if the scene has no such
// face.
[[nodiscard]] ReceiverView view_from(const Receiver& receiver, const ScaledScene& scene);

// The key of the random-number stream for this combination of seed, receiver and source.
[[nodiscard]] std::uint64_t stream_key(const ReceiverView& view, const Selection& source, std::uint64_t seed);

// Exact: x is strictly in front of the plane.
[[nodiscard]] bool in_front(const ReceiverView& view, const SourcePlane& plane);

// +1 if x is in front of the piece's plane, 0 if in it. Exact. `front`: the plane_normal of the piece's frame.
[[nodiscard]] int side_of_x(const ReceiverView& view, const ScaledScene& scene, const Piece& piece,
                            const Normal& front);

enum class Horizon { kClips, kIgnored };

// The result of gather_occluders.
struct Gathered {
  OccluderSet occluders;
  std::vector<std::uint32_t> sharp_pieces;  // of the occluders that single precision can locate
  std::vector<std::uint32_t> blurred;       // the other occluders' indices
  std::size_t looked_at = 0;                // pieces that the tree could not exclude
  std::vector<HalfSpace> half_spaces;       // scratch space
  SeenPolygon seen;                         // scratch space
};

// Finds every piece that may hide from x a part of a convex polygon of the source, given by its corners relative to x
// (all above the horizon, if it clips). An occluder is blurred if its plane passes x at a distance below `blur`, or if
// it lies closer than `blur` to the source's plane. Returns false with an incomplete list if more than `most` pieces
// remain that the tree cannot exclude.
bool gather_occluders(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane,
                      std::span<const Vec3> polygon, Horizon horizon, double blur, Gathered& gathered,
                      std::size_t most = std::numeric_limits<std::size_t>::max());

// The same among the given pieces; all occluders count as blurred.
void gather_blurred(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane,
                    std::span<const Vec3> polygon, Horizon horizon, std::span<const std::uint32_t> pieces,
                    Gathered& gathered);

// Calls visit(piece) for every piece whose box comes within `distance` of x.
template <class Visit>
void visit_pieces_near(const ScaledScene& scene, const Vec3& x, double distance, Visit&& visit) {
  const HalfSpace box[] = {{{1, 0, 0}, -distance},  {{-1, 0, 0}, -distance}, {{0, 1, 0}, -distance},
                           {{0, -1, 0}, -distance}, {{0, 0, 1}, -distance},  {{0, 0, -1}, -distance}};
  scene.tree.query(x, box, [&](std::uint32_t piece) {
    visit(piece);
    return true;
  });
}

// --- Sampled scene ---

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

// --- Value range ---

// Only this function clamps a sampled value to the range that its method promises.

enum class Formula {
  kUnit,         // all its values lie in [0, 1]; others are rounding errors
  kNotNegative,  // its values may exceed 1
  kAny,
};

// Requires a number, perhaps infinite: a formula may exceed the largest double. Returns the nearest finite double that
// the formula could have had without rounding errors.
[[nodiscard]] inline double move_into_range(double value, Formula formula) {
  EXACTFF_EXPECT(!std::isnan(value));
  constexpr double kLargest = std::numeric_limits<double>::max();
  constexpr double kRoundingAboveOne = 1e-12;  // sums of a method's terms exceed 1 by no more through rounding
  if (formula == Formula::kAny) return std::clamp(value, -kLargest, kLargest);
  const bool rounds_to_one = value <= 1.0 + kRoundingAboveOne || formula == Formula::kUnit;
  return std::min(std::max(0.0, value), rounds_to_one ? 1.0 : kLargest);  // -0 becomes 0
}

}  // namespace exactff::adaptive
