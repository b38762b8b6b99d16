// The sign, on a cell, of the quadratic function that orders two crossings on an edge (cell_view.h).
#pragma once

#include "view_factors/cell.h"

namespace exactff::view_factors {

// The sign of f(x) = det(N_e, N_g, N_h) everywhere inside the cell, N = (a - x) x (b - x) for a line through a and b; 0
// if f vanishes there; kMixed if the polar form does not decide.
//
// Filter. Let u = 2^-53 and e = 8u. Coordinates are at most 1 and rounded once; middles of two corners, twice. So a
// component of a - x, or of b - a, errs by at most e. Let A and L bound the magnitudes of their components, rounded or
// not. A component of N = (a - x) x (b - a) errs by at most 2 (A + L) e, and 5u A L for its own roundings: less than
// r = 4 (A + L) e, and is at most S = 2 A L + r. The determinant is a sum of six products of three such components,
// each wrong by at most r S S + S r S + S S r, and its roundings add at most 8u S S S to each. The roundings of the
// polar form add less than as much again. So each f errs by at most
//   6 (r S S + S r S + S S r + 2 e S S S),
// and the polar form by the sum of these with its coefficients. Underflow adds less than 2^-1000.
[[nodiscard]] int crossing_order(const Points& points, const Cell& cell, LineId e, LineId g, LineId h);

}  // namespace exactff::view_factors
