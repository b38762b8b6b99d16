// One receiver's view of a scene: which planes face it, and which pieces may lie between it and a source.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "adaptive/shaft.h"
#include "adaptive/source_roots.h"
#include "exactff/adaptive.h"
#include "receivers/own_pieces.h"
#include "scene/shaft_tree.h"

namespace exactff::adaptive {

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

}  // namespace exactff::adaptive
