// The visible boundary by the edge engine, by predicates alone. A corner is constructed only where an edge crosses the
// horizon or the source's plane (plane_crossings.h).
//
// Steps 1 to 6 of the exact method (src/README.md), stopping as soon as nothing is left:
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. clip the pieces that the receiver's horizon cuts (piece_clip.h);
//   3. find candidates in the shaft (candidates.h);
//   4. stop if one of them hides all;
//   5. try a few that may hide all together (cover_proof.h); before step 3, those that hid the plane from the receiver
//      before, if the caller allows it;
//   6. cut the edges: find the visible parts of each (visible_edges.h).
#pragma once

#include <optional>

#include "visibility/edge_workspace.h"
#include "visibility/plane_visibility.h"

namespace exactff::visibility {

// Lists a cutter only where one occluder hides all.
// Returns nullopt where the Booleans are the better method (visible_edges.h).
std::optional<PlaneVisibility> find_by_edges(const View& view, const SourcePlane& plane, const BoundaryRequest& request,
                                             EdgeWorkspace& workspace);

}  // namespace exactff::visibility
