// The boundary of the visible region, in the form that the contour integral takes.
//
// A piece lies on a supporting edge from a to b (exact directions from x, each known up to its own positive factor);
// the point with the homogeneous parameter (l : m) lies in direction l a + m b. A piece runs from `begin` to `end`. The
// pieces of one plane form closed loops. Seen from x, the visible region is on their left.
// Eq. (4) depends on nothing else, so any method that finds the pieces can supply them.
#pragma once

#include "kernel/exact_vec.h"

namespace exactff::visibility {

struct EdgeParameter {
  kernel::Integer l;
  kernel::Integer m;
};

struct BoundaryPiece {
  kernel::ExactVec3 a;
  kernel::ExactVec3 b;
  EdgeParameter begin{1, 0};
  EdgeParameter end{0, 1};
};

}  // namespace exactff::visibility
