// Triangles for a polygon that is not exactly planar, by a rule that depends only on the polygon.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/face_points.h"

namespace exactff {

using TriangleIndices = std::array<std::size_t, 3>;

// A quadrilateral takes the valid diagonal that holds the vertex of lowest index; a larger polygon is clipped ear
// by ear, each time the valid ear whose tip has the lowest index. Valid: seen along the Newell vector, both
// triangles (the ear) run counter-clockwise, and no vertex that could hide behind the ear's base lies in the
// closed ear, unless at the position of one of its corners. `index` gives each point's index in the file.
// Start and direction of the ring do not matter. Empty if no valid diagonal or ear is left.
std::optional<std::vector<TriangleIndices>> clip_ears(const PlanePoints& plane, std::span<const std::uint32_t> index);

}  // namespace exactff
