// Walls: the opaque pieces in one plane taken together, such as those around a doorway.
//
// The boundary of a wall consists of the parts of its pieces' edges that have pieces on one side only. Where pieces
// overlap, parts inside the wall may be listed as well; a test against all that is listed stays on the safe side.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "kernel/filter.h"
#include "scene/shaft_tree.h"

namespace exactff::visibility {

struct Wall {
  using Corners = std::vector<Vec3>;  // counter-clockwise as seen from the positive side
  static constexpr std::size_t kMostSegments = 256;
  using Segments = std::bitset<kMostSegments>;
  struct Line {
    Vec3 a, b;
    Segments left, right;  // the parts of the boundary on its closed left and right, as seen from the positive side
  };

  kernel::PlaneThrough plane;
  std::vector<Corners> pieces;
  std::vector<Line> lines;      // that hold parts of the boundary; first those with all of the wall on their left
  std::size_t outer_lines = 0;  // the number of these
  Segments boundary;
};

// All walls that may hide something: the scene lies on both sides of them.
[[nodiscard]] std::vector<Wall> walls_of(const Scene& scene);

// Each once: a box may be flat.
[[nodiscard]] std::vector<Vec3> corners_of(const Box& box);

// --- Seen pieces ---

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

// All pieces but some that are certainly hidden, by single walls, from all points of the region. Decided by exact
// signs. In the order of the shaft tree. `walls`: those of the scene.
[[nodiscard]] std::vector<std::uint32_t> pieces_seen_from(const Scene& scene, std::span<const Wall> walls,
                                                          const Box& region);

// Whether any of these pieces, in ascending order, is among them, found without looking at most of the others.
[[nodiscard]] bool sees_any_of(const Scene& scene, std::span<const Wall> walls, const Box& region,
                               std::span<const std::uint32_t> pieces);

}  // namespace exactff::visibility
