// Finds the boundary of the region of one source plane that is visible from a receiving point.
//
// Steps, stopping as soon as nothing is left:
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. exact clip by the receiver's horizon;
//   3. shaft: candidates from the bounding-volume tree, exact predicates, exact clip (shaft.h);
//   4. no candidates: the boundary of the clipped source itself;
//   5. one candidate hides all: nothing is visible;
//   6. projection to the source's plane and polygon Booleans (plane_frame.h, polygon_sets.h);
//   7. boundary loops of the visible region, collinear pieces merged.
// This module contains no radiometry.
#pragma once

#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/record.h"
#include "scene/shaft_tree.h"
#include "visibility/boundary_piece.h"
#include "visibility/plane_frame.h"
#include "visibility/polygon_sets.h"
#include "visibility/shaft.h"
#include "visibility/source_plane.h"

namespace exactff::visibility {

// Everything that depends on the receiver alone.
struct View {
  View(const Scene& scene_in, const Receiver& receiver);

  const Scene& scene;
  Vec3 x;
  Vec3 n;  // the receiver's normal
  std::optional<FaceId> on;
  // The normal as a direction in integers, which are seldom needed.
  [[nodiscard]] kernel::Direction normal() const;
};

struct Request {
  Engine engine = Engine::kEdges;
  bool fraction = false;
  bool list_cutters = false;
  bool keep_geometry = false;                           // for drawings
  const std::vector<FaceId>* only_occluders = nullptr;  // ascending
  ShaftCulling culling = ShaftCulling::kTree;
};

// The exact geometry behind a result, for drawings.
struct PlaneGeometry {
  std::vector<kernel::Ring> source;   // convex pieces in front of x, whole
  std::vector<kernel::Ring> clipped;  // above the horizon
  std::vector<Occluder> occluders;
  std::optional<PlaneFrame> frame;
  std::vector<RegionLoop> visible;  // in the frame
};

class VisibleEdges;

// One occluder that hides all needs no allocation.
using Cutters = boost::container::small_vector<FaceId, 1>;

struct PlaneVisibility {
  PlaneRecord record;                   // without its faces, which are the plane's
  std::vector<BoundaryPiece> boundary;  // by the Booleans
  VisibleEdges* edges = nullptr;  // by the edge engine: valid until this thread's next call; null if nothing is visible
  std::optional<kernel::Rational> fraction;  // visible area / whole unclipped area of the union, in [0, 1]
  Cutters cutters;                           // ascending
  PlaneGeometry geometry;
};

// For both engines: calls visit(piece, inside) for every piece that may lie in the shaft, until one call returns false;
// inside: certainly within it (shaft_tree.h).
template <class Visit>
void for_each_candidate(const View& view, const HalfSpaceGroups& shaft, ShaftCulling culling, Visit&& visit) {
  if (culling == ShaftCulling::kTree) {
    shaft_tree(view.scene).query_with_inside(view.x, shaft, visit);
    return;
  }
  const auto count = static_cast<std::uint32_t>(view.scene.pieces().size());
  for (std::uint32_t piece = 0; piece < count && visit(piece, false); ++piece) {
  }
}

// For both engines: true if a piece of the scene may occlude the plane. The source's own pieces in this plane cannot;
// its pieces in other planes can.
[[nodiscard]] bool may_occlude(const View& view, const SourcePlane& plane, const Request& request, std::uint32_t piece);
// Twice an area in the frame's unit square, as a share of the whole unclipped source in the plane.
[[nodiscard]] kernel::Rational share_of_source(const View& view, const SourcePlane& plane, const PlaneFrame& frame,
                                               const kernel::Rational& doubled);

// Exact. Requires a receiver normal that is not zero.
PlaneVisibility find_visible_boundary(const View& view, const SourcePlane& plane, const Request& request);

}  // namespace exactff::visibility
