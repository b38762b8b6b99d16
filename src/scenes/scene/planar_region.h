// The inside of a planar polygon with holes, as convex parts.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/face_points.h"

namespace exactff {

enum class RegionFault {
  kNone,
  kCrossing,     // two edges cross in their interiors: `edges`
  kWinding,      // the outer ring encloses something clockwise or more than once
  kHoleOutside,  // a hole reaches outside the outer ring
};

struct PlanarRegion {
  RegionFault fault = RegionFault::kNone;
  std::pair<EdgeIndex, EdgeIndex> edges;
  bool encloses_something = false;              // some part lies inside the outer ring, in either direction of the ring
  std::vector<std::vector<std::size_t>> parts;  // point indices, counter-clockwise in the plane
};

// A point is inside if the outer ring winds around it once counter-clockwise and the other rings, by even-odd parity,
// do not contain it. Exact. `plane` holds the points projected with a normal of their plane, `vertices` the same points
// as they were given; `normal` has any length.
PlanarRegion planar_region(std::span<const Vec3> vertices, const FacePoints& points, const PlanePoints& plane,
                           const kernel::ExactVec3& normal);

// --- Edge crossing ---

// Finds edges of rings that cross.

// Two edges of `points` that cross in their interiors, the one of lower index first; any such pair, or nullopt if there
// is none. Edges may touch, overlap and have no length. O(n log n), exact.
std::optional<std::pair<EdgeIndex, EdgeIndex>> find_crossing(const FacePoints& points, const PlanePoints& plane);

}  // namespace exactff
