// The visible boundary by the edge engine: the steps of visible_boundary.h with nothing constructed.
//
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. clip by the receiver's horizon: only what it cuts is constructed, exactly;
//   3. shaft: candidates from the bounding-volume tree; then signs of heights above the source's edges, once a vertex.
//   A
//      face that the source's plane cuts is clipped (plane_crossings.h); no face is clipped to the shaft;
//   4. and 5. no candidates, or one that hides all;
//   6. and 7. what is left of every edge (visible_edges.h).
#pragma once

#include "visibility/visible_boundary.h"

namespace exactff::visibility {

// Lists a cutter only where one occluder hides all, and keeps no geometry.
// Nothing where the Booleans are the better way (visible_edges.h).
std::optional<PlaneVisibility> find_by_edges(const View& view, const SourcePlane& plane, const Request& request);

}  // namespace exactff::visibility
