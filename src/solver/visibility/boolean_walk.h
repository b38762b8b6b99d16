// The visible boundary by polygon Booleans: the reference engine.
//
// Steps, stopping as soon as nothing is left:
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. exact clip by the receiver's horizon;
//   3. shaft: candidates from the bounding-volume tree, exact predicates, exact clip (shaft.h);
//   4. no candidates: the boundary of the clipped source itself;
//   5. one candidate hides all: nothing is visible;
//   6. projection to the source's plane and polygon Booleans (plane_frame.h, polygon_sets.h);
//   7. boundary loops of the visible region, collinear pieces merged.
#pragma once

#include "visibility/plane_frame.h"
#include "visibility/plane_visibility.h"
#include "visibility/polygon_sets.h"
#include "visibility/shaft.h"

namespace exactff::visibility {

PlaneVisibility find_by_booleans(const View& view, const SourcePlane& plane, const Request& request);

// The cutters alone (steps 1 to 3).
Cutters find_cutters(const View& view, const SourcePlane& plane, const Request& request);

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
