// The visible boundary by polygon Booleans: the reference engine.
//
// Steps 1 to 7 of the exact method (src/README.md) without steps 3 and 6, stopping as soon as nothing is left:
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. clip by the receiver's horizon, exactly;
//   4. find candidates in the shaft: bounding-volume tree, exact predicates, exact clip;
//   5. stop if one of them hides all;
//   7. the boundary: of the clipped source itself if there are no candidates, otherwise by projection to the source's
//      plane and polygon Booleans (polygon_sets.h); its loops, collinear pieces merged.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactff/exact.h"
#include "exactff/scene.h"
#include "kernel/filter.h"
#include "scene/shaft_tree.h"
#include "visibility/plane_visibility.h"
#include "visibility/polygon_sets.h"

namespace exactff::visibility {

// --- Shaft ---

// The shaft is the open pyramid from x to the convex hull of the clipped source. Only pieces that enter it can hide a
// part of the source. This class tests pieces against it and finds their part in it.
//
// Notation: s_i corners of the hull, t_j corners of an occluding piece, both relative to x; M the source's normal
// turned away from x, h = M . s > 0. A piece hides a part of positive area exactly if its intersection with
//   { t : M . t < h }  and  { t : (s_i+1 x s_i) . t > 0 for every side i }
// has an interior in the piece's own plane and that plane does not contain x.
//
// Steps 4 and 5 of the exact method (src/README.md) for one piece, each a sign with a filter first and an exact product
// last:
//   a. nothing strictly on x's side of the source's plane, nothing ahead of x, or everything on or outside one side
//      plane: outside (conservative; most pieces end here);
//   b. its plane contains x: outside, since x sees it edge-on;
//   c. exact clip by the source's plane;
//   d. every s_i inside or on every plane (x, t_j, t_j+1): the piece hides the whole source, and the hull is its part
//      in the shaft;
//   e. exact clip by the side planes: outside if nothing is left. A clip keeps an interior as long as one corner lies
//      strictly inside, so no area needs to be computed.

struct Occluder {
  FaceId face{};
  Ring ring;  // clipped to the shaft, as x sees it
};

enum class Fate { kOutside, kInShaft, kHidesAll };

class Shaft {
 public:
  // `hull`: strictly convex, as x sees it. `front`: the source's front normal; x is in front. `point`: any point in its
  // plane.
  Shaft(const Scene& scene, const Vec3& x, const Ring& hull, const ExactVec3& front, const Vec3& point);

  // For the bounding-volume tree.
  [[nodiscard]] std::span<const HalfSpace> half_spaces() const { return half_spaces_; }

  // Classifies a piece. Unless it is outside, `occluder` receives its part in the shaft. `was_cut`: that part is less
  // than the whole piece; if the piece hides everything, only the cut by the source's plane counts.
  // Without culling, step a tests only the source's plane, since step c relies on it; step e decides the rest.
  Fate test(std::uint32_t piece, ShaftCulling culling, Occluder& occluder, bool& was_cut);

 private:
  struct Offset {  // h = value * 2^exponent
    Integer value;
    long exponent = 0;
    double approx = 0.0;  // in the scale of toward_.approx
  };

  [[nodiscard]] bool may_meet(std::span<const std::uint32_t> corners, ShaftCulling culling);
  [[nodiscard]] int depth_sign(std::size_t corner);  // sign of M . t - h
  [[nodiscard]] int side_sign(const Direction& normal, std::size_t corner);
  const ScaledVec3& exact_corner(std::size_t corner);
  bool clip_to_source_plane(Ring& ring);
  [[nodiscard]] bool hides_all(const Ring& ring) const;

  const Scene& scene_;
  Vec3 x_;
  Ring hull_;
  std::vector<Direction> sides_;
  Direction toward_;  // M
  Offset offset_;
  std::vector<HalfSpace> half_spaces_;

  // The current piece.
  std::span<const std::uint32_t> corners_;
  std::vector<Approx3> approx_corners_;
  std::vector<std::optional<ScaledVec3>> exact_corners_;
  std::vector<int> depth_;
};

// --- Boolean walk ---

PlaneVisibility find_by_booleans(const View& view, const SourcePlane& plane, const BoundaryRequest& request);

// The cutters alone (steps 1 to 5).
Cutters find_cutters(const View& view, const SourcePlane& plane, const BoundaryRequest& request);

// The exact geometry behind a result, for drawings.
struct PlaneGeometry {
  std::vector<Ring> source;   // convex pieces in front of x, whole
  std::vector<Ring> clipped;  // above the horizon
  std::vector<Occluder> occluders;
  std::optional<PlaneFrame> frame;
  std::vector<RegionLoop> visible;  // in the frame
};
PlaneGeometry find_geometry(const View& view, const SourcePlane& plane);

// --- Convex clip ---

// Exact clipping of convex polygons, seen from the receiving point, by planes through that point.

enum class ClipResult {
  kInside,  // no corner strictly outside: the ring is unchanged
  kCut,
  kEmpty,  // no corner strictly inside: nothing with an interior is left; the ring is cleared
};

// Keeps the part of `ring` with normal . t >= 0. Corners constructed by the cut are directions only: positive
// combinations of two corners, at any scale.
ClipResult clip(Ring& ring, const Direction& normal);

// The direction in which the segment from a (at signed distance da) to b (at db, of the other sign) meets the plane:
// a |db| + b |da|, with common factors divided out.
Direction crossing(const ExactVec3& a, const Integer& da, const ExactVec3& b, const Integer& db);

// Inward normals of the planes through x and each side of the ring.
std::vector<Direction> side_planes(const Ring& ring);

}  // namespace exactff::visibility
