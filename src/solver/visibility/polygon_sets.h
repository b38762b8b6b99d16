// Polygon Booleans in exact rational arithmetic. Only this module uses CGAL's polygon sets.
//
// Requires polygons that are counter-clockwise, simple, of positive area, with coordinates of moderate size. They are
// images of convex rings that were clipped, and PlaneFrame ensures the last: the sets fail once a coordinate or a
// difference reaches 2^1024.
#pragma once

#include <span>
#include <vector>

#include "visibility/plane_frame.h"

namespace exactff::visibility {

// A boundary loop without collinear corners, the region to its left: outer loops run counter-clockwise, holes
// clockwise. A loop may touch itself at a corner.
struct RegionLoop {
  Polygon2 corners;
  bool hole = false;
};

// The union of the polygons.
std::vector<RegionLoop> join(std::span<const Polygon2> polygons);

// The union of `source` minus the union of `occluders`, computed by one join of each and one difference.
std::vector<RegionLoop> difference(std::span<const Polygon2> source, std::span<const Polygon2> occluders);

// The convex hull, counter-clockwise, without collinear corners.
Polygon2 convex_hull(std::span<const Polygon2> polygons);

// Twice the area of a region given by its loops.
kernel::Rational doubled_area(std::span<const RegionLoop> loops);

}  // namespace exactff::visibility
