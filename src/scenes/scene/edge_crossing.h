// Finds edges of rings that cross.
#pragma once

#include <optional>
#include <utility>

#include "scene/face_points.h"

namespace exactff {

// Two edges of `points` that cross in their interiors, the one of lower index first; any such pair, or nullopt if there
// is none. Edges may touch, overlap and have no length. O(n log n), exact.
std::optional<std::pair<EdgeIndex, EdgeIndex>> find_crossing(const FacePoints& points, const PlanePoints& plane);

}  // namespace exactff
