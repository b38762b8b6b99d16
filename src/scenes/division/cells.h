// Cuts a convex polygon, whose outline is cut already, into cells.
//
// 1. A polygon is a cell if it has at most four corners, none of them straight, or if no two corners are farther apart
//    than LENGTH. A cell is exactly planar; one that is not is cut into triangles.
// 2. Otherwise it is cut along a chord between two points of its outline: the shortest that leaves at least a quarter
//    of the area on either side; of several, the one whose parts are the most alike. A chord longer than LENGTH is cut
//    into equal lengths, whose points both sides share. So no cell has a point of another one of the polygon inside
//    an edge, and a rectangle becomes a grid.
// 3. Both parts are cut likewise.
//
// It ends: a chord that is not cut leaves fewer points on either side. One is cut only where the area exceeds a
// fraction of LENGTH^2, and the areas of the parts fall in proportion.
//
// Lengths and areas are estimates; only planarity is decided exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "division/cut_points.h"

namespace exactff::division {

using Polygon = std::vector<std::uint32_t>;  // vertices, counter-clockwise seen from its front

// Requires at least three points, about in one plane and convex. Adds the cells in an order that depends on the
// polygon alone.
void cut_into_cells(const Polygon& polygon, CutPoints& points, std::vector<Polygon>& cells);

// Whether two points of these are farther apart than LENGTH.
[[nodiscard]] bool is_wide(std::span<const std::uint32_t> vertices, const CutPoints& points);

}  // namespace exactff::division
