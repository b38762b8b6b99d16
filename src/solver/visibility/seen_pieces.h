// The pieces that points of a region may see, for many views from one place.
//
// Let R and Q be convex polygons or boxes. Let every corner r of R lie strictly on one side of a wall's plane, and
// every corner q of Q on the other side or in the plane, not all of them in it. The segments from R to Q cross the
// plane in the hull P of the crossings of the segments from an r to a q. Proof: from r, the central projection onto the
// plane maps Q into the hull of the projections of its corners; from a point y of Q, in the same way, it maps R.
//
// The wall hides Q from R, but for directions of measure zero, if it holds P. It does so if
// - it is one convex piece, and P lies on the inner side of each of its lines; or
// - each part of the wall's boundary lies on the other side of some line than P, or on this line, and one of the
//   crossings lies inside a piece. For then no part of the boundary meets the inside of P, which is connected and of
//   which some is in the wall. (If P has no inside, R sees Q edge on.)
//
// A piece that is hidden from all points of R can be left out of their views: the wall hides whatever it hides.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "scene/shaft_tree.h"
#include "visibility/walls.h"

namespace exactff::visibility {

// All pieces but some that are certainly hidden, by single walls, from all points of the region. Decided by exact
// signs. In the order of the shaft tree. `walls`: those of the scene.
[[nodiscard]] std::vector<std::uint32_t> pieces_seen_from(const Scene& scene, std::span<const Wall> walls,
                                                          const Box& region);

// Whether any of these pieces, in ascending order, is among them, found without looking at most of the others.
[[nodiscard]] bool sees_any_of(const Scene& scene, std::span<const Wall> walls, const Box& region,
                               std::span<const std::uint32_t> pieces);

}  // namespace exactff::visibility
