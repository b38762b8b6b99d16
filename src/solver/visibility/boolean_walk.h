// The visible boundary by polygon Booleans: the reference engine.
//
// Steps 1 to 6 of the exact method (src/README.md) without step 5, stopping as soon as nothing is left:
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. clip by the receiver's horizon, exactly;
//   3. find candidates in the shaft: bounding-volume tree, exact predicates, exact clip (shaft.h);
//   4. stop if one of them hides all;
//   6. the boundary: of the clipped source itself if there are no candidates, otherwise by projection to the source's
//      plane and polygon Booleans (plane_frame.h, polygon_sets.h); its loops, collinear pieces merged.
#pragma once

#include "visibility/plane_frame.h"
#include "visibility/plane_visibility.h"
#include "visibility/polygon_sets.h"
#include "visibility/shaft.h"

namespace exactff::visibility {

PlaneVisibility find_by_booleans(const View& view, const SourcePlane& plane, const BoundaryRequest& request);

// The cutters alone (steps 1 to 4).
Cutters find_cutters(const View& view, const SourcePlane& plane, const BoundaryRequest& request);

// The exact geometry behind a result, for drawings.
struct PlaneGeometry {
  std::vector<kernel::Ring> source;   // convex pieces in front of x, whole
  std::vector<kernel::Ring> clipped;  // above the horizon
  std::vector<Occluder> occluders;
  std::optional<PlaneFrame> frame;
  std::vector<RegionLoop> visible;  // in the frame
};
PlaneGeometry find_geometry(const View& view, const SourcePlane& plane);

}  // namespace exactff::visibility
