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
// isoperimetric inequality on the sphere, L^2 >= A (4 pi - A) for its perimeter L, and A <= 2 pi, so A <= L^2 / (2 pi),
// and
//
//   |F - F0| <= L^2 / pi^2.
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
// angle between them cannot grow from 0 beyond 30 degrees while its sine stays below 1/2.
//
// A side on e, from the crossing with g to that with h, has the sine |N_e| |f| / (|N_e x N_g| |N_e x N_h|), where
// f = det(N_e, N_g, N_h). On the cell, |f| is at most the largest |b| of its polar form; |N| is convex, so its largest
// value is at a corner; and |N_e x N_g| is at least the smallest coefficient of the polar form of its component along
// the direction that it has at the centre.
#pragma once

#include <array>
#include <vector>

#include "view_factors/cell.h"

namespace exactff::view_factors {

using CrossingTriple = std::array<LineId, 3>;  // ascending

// Infinite where a crossing may be near an end of its edges' planes. In double, with a margin for roundings.
[[nodiscard]] double event_bound(const Points& points, const Cell& cell, const Vec3& centre,
                                 std::vector<CrossingTriple> triples);

}  // namespace exactff::view_factors
