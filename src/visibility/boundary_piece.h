// The boundary of the visible region, as the contour integral wants it.
//
// A piece lies on a supporting edge from a to b (exact directions from x, each up to a positive factor of its own);
// the point with the homogeneous parameter (l : m) lies in direction l a + m b. A piece runs from `begin` to `end`.
// Together the pieces of a plane form closed loops with the visible region to their left as x sees it.
// Eq. (4) depends on nothing else, so whoever finds the pieces, by whatever method, can hand them over.
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
