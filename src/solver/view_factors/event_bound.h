// How wrong the formula of a cell's centre can be elsewhere in the cell, if only orders of crossings are undecided.
//
// Let three edges lie on the lines e, g, h, and let only the order of their crossings be undecided on the cell. Let F0
// be the contour integral over the parts that bound the visible region from the centre, continued to x: their ends move
// with the lines, and a part whose ends have changed places counts with the opposite sign. Let F be the true value.
//
// The two contours at x differ only along the three lines, and only between the crossings, since all other signs are
// the same: their difference is a closed chain of the three sides of one spherical triangle, hence a multiple of its
// boundary. A coefficient is 1, 0 or -1 in either contour, so the multiple is at most 2. The difference of the
// integrals is the multiple times the integral of cos / pi over the triangle, at most 2 / pi times its area A. By the
// isoperimetric inequality on the sphere, L^2 >= A (4 pi - A) for its perimeter L. Here A <= 2 pi, so
//
//   A <= L^2 / (2 pi),   |F - F0| <= L^2 / pi^2.
//
// Several such triples of which no two share a line change the contour in separate places, and their bounds add up. If
// two share a line, the difference is a closed chain on all these lines, and no shape is known: each side contributes
// at most 2 / (2 pi) of its length, since |cos| <= 1 in Eq. (4). There a coefficient of F0 may exceed 1. On one edge,
// let the ends of its parts be f_1, t_1, f_2, t_2, ... in the order at the centre, and S those of them before a place y
// of the edge at x. The coefficient of F0 at y is c, the number of f in S less the number of t in S; that of F is 0 or
// 1. A pair of an end in S and one that is earlier at the centre, but not in S, has changed its order, and its side
// holds y. Of the f in S, the k-th one is preceded by k - 1 or more t; if c >= 2, this makes c (c - 1) / 2 such pairs
// or more. Likewise |c| (|c| + 1) / 2 if c < 0. So twice the number of pairs is at least the difference of the
// coefficients. If c is 0 or 1 and the coefficients differ, some pair has changed its order, too.
//
// That the crossings of a pair are close to each other, not nearly opposite, is no matter: if f has no zero on the
// cell, its order is that at the centre. If it has one, the crossings coincide there, both being on one edge, and the
// angle between them cannot grow from 0 beyond 31 degrees while its sine stays below 0.51.
//
// A side on e, from the crossing with g to that with h, has the sine |N_e| |f| / (|N_e x N_g| |N_e x N_h|), where
// f = det(N_e, N_g, N_h). On the cell, |f| is at most the largest |b| of its polar form; |N| is convex, so its largest
// value is at a corner; and |N_e x N_g| is at least the smallest coefficient of the polar form of its component along
// the direction that it has at the centre.
//
// Roundings. Let u = 2^-53. Coordinates are at most 1 and rounded once, those of the middle of two corners twice. So a
// component of p = a - x or q = b - x is at most 2 and errs by at most 5u, |p|, |q| <= sqrt(12), and p and q err by at
// most 5 sqrt(3) u. A component of N = p x q is twice the area of a triangle in a square of side 2, hence at most 4,
// and |N| <= 4 sqrt(3) < 7.
// - N errs by 2 sqrt(12) 5 sqrt(3) u = 60u for p and q, and by sqrt(3) 16u for its own roundings: less than 90u.
// - f is a sum of six products of at most 4^3 with five roundings each: it errs by 3 (90u) 7^2 + 6 (4^3) 5u < 2^14 u.
//   So does the component of N_g x N_h along d, |d| <= 2: by less than 2 (90u) 7 |d| + 6 (4^2) 5u |d|.
// - Both are at most 7^3. A coefficient of the polar form, of three values, errs by 3 (2^14 u) + 4 (7^3 u) < 2^-37.
//   kRoundings = 2^-34 is added to the largest |b| and subtracted from the smallest component, so these are bounds.
//   (The length of d errs by less than 2^-20, but where |N_g x N_h| at the centre is below 2^-500. Then the smallest
//   component is below 2^-34, and nothing is claimed.)
// - A computed |N| may be too small. But where the bounds of |N_e x N_g| are positive, the component is more than
//   2^-34 - 2^-37 at every corner, which is less than 7.1 |N_e|. So |N_e| > 2^-38, and it errs by less than
//   90u / 2^-38 < 0.28 % of it.
// So a true sine is less than 1.003 times the one computed, which is below 1/2. Up to 0.51 the arc sine grows by less
// than 1.17 times its argument, and is not smaller than this: the angles are below 1.0036 times those computed, and
// their squares below 1.0073 times. Other roundings are relative and below 2^-30, with fewer than 2^20 triples. All
// this is less than kEventMargin.
#pragma once

#include <array>
#include <vector>

#include "view_factors/cell.h"

namespace exactff::view_factors {

using CrossingTriple = std::array<LineId, 3>;  // ascending

// What the sides of one triple's triangle are computed from, on the cell. Requires a cell and lines whose coordinates
// are at most 1.
struct TriangleBounds {
  double order = 0.0;              // at least |f|
  std::array<double, 3> normal{};  // |N_i|, the largest
  std::array<double, 3> cross{};   // at most |N_i x N_(i + 1)|
};
[[nodiscard]] TriangleBounds triangle_bounds(const Points& points, const Cell& cell, const Vec3& centre,
                                             const CrossingTriple& triple);

// In double: times kEventMargin, it is not below the bound. Infinite where a crossing may be near an end of its edges'
// planes.
[[nodiscard]] double event_bound(const Points& points, const Cell& cell, const Vec3& centre,
                                 std::vector<CrossingTriple> triples);
inline constexpr double kEventMargin = 1.01;

}  // namespace exactff::view_factors
