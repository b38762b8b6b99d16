// The triangles of a plane region with holes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "visibility/plane_frame.h"

namespace exactff::whole_view {

using TriangleCorners = std::array<std::uint32_t, 3>;  // indices of points

// A constrained Delaunay triangulation of the region that the loops have on one side. Exact: no point is added.
// Requires distinct points, sides that do not cross, and a region that is on the left of all loops or on the right of
// all, as the loops of a Region are. Triangles run counter-clockwise. Where four corners lie on a circle, the order of
// the loops decides.
[[nodiscard]] std::vector<TriangleCorners> triangles_of(std::span<const visibility::Point2> points,
                                                        std::span<const std::vector<std::uint32_t>> loops);

}  // namespace exactff::whole_view
