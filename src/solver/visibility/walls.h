// Walls: the opaque pieces in one plane taken together, such as those around a doorway.
//
// The boundary of a wall consists of the parts of its pieces' edges that have pieces on one side only. Where pieces
// overlap, parts inside the wall may be listed as well; a test against all that is listed stays on the safe side.
#pragma once

#include <bitset>
#include <cstddef>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "kernel/plane_through.h"
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

}  // namespace exactff::visibility
