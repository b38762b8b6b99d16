// Finds the boundary of the region of one source plane that is visible from a receiving point: chooses the engine.
#pragma once

#include "visibility/edge_workspace.h"
#include "visibility/plane_visibility.h"

namespace exactff::visibility {

// Exact. Requires a receiver normal that is not zero. The edge engine, unless the Booleans are requested or are the
// better method (visible_edges.h).
PlaneVisibility find_visible_boundary(const View& view, const SourcePlane& plane, const BoundaryRequest& request,
                                      EdgeWorkspace& workspace);

}  // namespace exactff::visibility
