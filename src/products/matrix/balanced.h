// The balanced matrix nearest to the values, inside all bounds.
//
// Notation: A_i areas, X_ij = A_i F_ij = X_ji. L_ij <= X_ij <= U_ij is what both directions of a pair allow, V_ij the
// mean of their two values, w_ij = U_ij - L_ij. Diagonal entries and those of (back), (open) and (buried), of which a
// row may have several, belong to one row alone; they are written X_ii. Wanted, over ordered pairs:
//
//   minimise sum (X_ij - V_ij)^2 / w_ij   with   sum_j X_ij = A_i for every row i,   L <= X <= U
//
// Method
// 1. With a multiplier l_i for each row, the minimum is X_ij = clip(V_ij + w_ij (l_i + l_j), L_ij, U_ij). So the sums
// of
//    rows, less the areas, are a monotone, piecewise linear function G(l), the gradient of a convex one.
// 2. Solve G(l) = 0 by semismooth Newton steps: the matrix of a step has the w_ij of the entries that are not clipped,
//    and their sums on the diagonal. It may be singular (bipartite parts, rows without such entries), so a share
//    of all w_ij of its row is added to the diagonal, ten times as much after a step that was too long, a tenth after
//    one that was not. Conjugate gradients solve it. Then the length of the step is searched, along which s . G is
//    monotone.
// 3. If a step leads on for ever, there is no solution, and its direction y proves it: for every X within the bounds,
//    sum_i y_i (sum_j X_ij) <= sum over pairs of the larger one of L_ij (y_i + y_j) and U_ij (y_i + y_j), and if this
//    is less than sum_i y_i A_i, then some row misses its area. This is checked, with all roundings against it.
// 4. Round: entries become doubles F_ij and F_ji with fl(A_i F_ij) = fl(A_j F_ji), fl being a product of doubles. Which
//    of the nearest such pairs is taken is decided by what the rows still lack, large entries first, so that the errors
//    of small ones make up for those of large ones.
// 5. A row that still misses 1 by more than an ulp moves one of its entries to another such pair, then the row at the
//    other end does, and so on along a walk. At last all rows are added up exactly: a matrix is found only if every
//    sum is within 2^-51 of 1.
//
// Of step 4: let A have the significand a in [1, 2), and x that of a double X. If x < a, products of A with the doubles
// near X / A are less than an ulp of X apart, so X is such a product. Otherwise they are a < 2 ulps apart, so of any W
// doubles at least W / a - 1 are. Of any 2 c / (2 - c), c being the larger significand of two areas, at least one is a
// product of both. If c is not very close to 2, that is a few ulps.
//
// Rows are taken in the order of their names, so the result depends neither on the order of patches nor on threads.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "exactff/error.h"
#include "exactff/matrix.h"

namespace exactff::matrix {

// Requires the same patches as rows and columns, and a name for each.
[[nodiscard]] Balanced balanced_of(const Matrix& matrix, std::span<const std::string> names);

// What balanced() refuses, by InputError, before its entries are known: `matrix` may have any.
void require_balanceable(const Scene& scene, const Matrix& matrix);

// Why a balanced matrix was not found. Empty if it was.
[[nodiscard]] std::vector<Problem> problems_of(const Scene& scene, const Matrix& matrix, const Balanced& balanced);

}  // namespace exactff::matrix
