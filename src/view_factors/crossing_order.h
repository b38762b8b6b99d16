// The sign, on a cell, of the quadratic function that orders two crossings on an edge (cell_view.h).
#pragma once

#include "view_factors/cell.h"

namespace exactff::view_factors {

// The sign of f(x) = det(N_e, N_g, N_h) everywhere inside the cell, N = (a - x) x (b - x) for a line through a and b; 0
// if f vanishes there; kMixed if the polar form does not decide.
//
// Filter. Coordinates are at most 1 and rounded once. With u = 2^-53, a difference errs by at most 4u, a component of N
// by 48u, the determinant by less than 2^17 u, and the polar form by less than 2^18 u + 2^15 u < 2^-34.
[[nodiscard]] int crossing_order(const Points& points, const Cell& cell, LineId e, LineId g, LineId h);

}  // namespace exactff::view_factors
