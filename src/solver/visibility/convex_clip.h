// Exact clipping of convex polygons, seen from the receiving point, by planes through that point.
#pragma once

#include "kernel/direction.h"

namespace exactff::visibility {

enum class ClipResult {
  kInside,  // no corner strictly outside: the ring is unchanged
  kCut,
  kEmpty,  // no corner strictly inside: nothing with an interior is left; the ring is cleared
};

// Keeps the part of `ring` with normal . t >= 0. Corners constructed by the cut are directions only: positive
// combinations of two corners, at any scale.
ClipResult clip(kernel::Ring& ring, const kernel::Direction& normal);

// The direction in which the segment from a (at signed distance da) to b (at db, of the other sign) meets the plane:
// a |db| + b |da|, with common factors divided out.
kernel::Direction crossing(const kernel::ExactVec3& a, const kernel::Integer& da, const kernel::ExactVec3& b,
                           const kernel::Integer& db);

// Drops corners that lie on the line through their neighbours. Requires positive area.
void drop_collinear_corners(kernel::Ring& ring);

// Inward normals of the planes through x and each side of the ring.
std::vector<kernel::Direction> side_planes(const kernel::Ring& ring);

}  // namespace exactff::visibility
