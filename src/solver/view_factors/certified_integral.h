// Integrals over cells, enclosed: Gauss quadrature with a proved remainder, every rounding counted.
//
// On [-1, 1], let g be analytic in the open ellipse with the foci -1 and 1 and the sum rho of its half axes,
// a = (rho + 1 / rho) / 2 and b = (rho - 1 / rho) / 2, and |g| <= M there. The coefficients of its Chebyshev series are
// at most 2 M rho^-k. The N-point rule, N >= 2, is exact for T_0, ..., T_(2N - 1) and for all odd T_k. The integral of
// an even T_k is -2 / (k^2 - 1), and the rule's value for it is at most 2, since its weights are positive and add up to
// 2. For k >= 4 the difference is at most 2 + 2 / 15 = 32 / 15. So the rule errs by at most
//
//   sum over even k >= 2N of 2 M rho^-k 32 / 15 = (64 / 15) M rho^(-2N) / (1 - rho^-2).
//
// On [0, 1] it is half of that. For two variables, Q_s and Q_t being the rules,
//
//   I_s I_t g - Q_s Q_t g = I_t (I_s - Q_s) g + Q_s (I_t - Q_t) g,
//
// and both I_t and Q_s add or average over numbers of [0, 1], of total weight 1. So the remainder is at most the sum of
// two such bounds, for g as a function of s in the ellipse with t in [0, 1], and of t in the ellipse with s in [0, 1].
// Here g is F times the map's Jacobian (see below), which carries the cell's size.
//
// M is a bound on the whole ellipse, not on its rim: that g is analytic inside follows from its evaluation there. Two
// discs cover the ellipse, about c and -c with c = 1 / (2a), of the radius r = sqrt(b^2 + c^2): a point
// (a cos w, b sin w), cos w >= 0, has the squared distance (a^2 - b^2) cos^2 w - 2 a c cos w + c^2 + b^2 from (c, 0),
// and with a^2 - b^2 = 1 and 2 a c = 1 this is r^2 - cos w (1 - cos w) <= r^2. A disc is convex and symmetrical, and so
// holds all points of the right half of the ellipse between its rim and the real axis, and those on the imaginary axis.
// Source of the one-dimensional bound: L. N. Trefethen, "Approximation Theory and Approximation Practice",
// theorem 19.3.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kernel/disc.h"
#include "view_factors/cell.h"
#include "view_factors/disc_terms.h"
#include "view_factors/formula.h"

namespace exactff::view_factors {

// --- Disc formula ---

// The formula of a cell (formula.h) in discs: enclosed at points, and bounded near the cell in the complex plane.
//
// A cell is cut at its first corner p into quadrilaterals, the last one perhaps a triangle, and each is the image of
// the unit square under
//
//   x(s, t) = p + s a + t b + s t c,
//
// one to one up to the sides of the square. For a quadrilateral with the corners p, q, v, w: a = q - p, b = w - p,
// c = v - q - b; for a triangle p, q, v: a = q - p, b = 0, c = v - q. With the receiver's unit normal n, the map's
// Jacobian is n . ((a + t c) x (b + s c)). It is not negative on the square, and has no term in s t. A function that is
// affine in x becomes k0 + k2 t + s (k1 + k3 t). F is a sum of terms that are made of such functions (disc_terms.h).
//
// Continuation. The integrand is wanted as an analytic function of s in an ellipse about [0, 1], for each real t (or
// the other way round). The ellipse is covered by discs about real centres in [0, 1]. In each disc the forms that were
// evaluated are analytic, and are equal to F on the real numbers near its centre. Two discs that overlap have a real
// point between their centres in common, where both are equal to F. So together they are one analytic function.
// An edge in the receiver's plane needs care: nu changes its sign on the edge's line. The cell lies on one side of it,
// and so do all centres, since they lie in [0, 1].

class DiscFormula {
 public:
  // Of the cell, or of a single point: a cell of one corner, which is x(0, 0).
  DiscFormula(const Formula& formula, const Cell& cell);

  // Takes the quadrilateral at these corners of the cell; the first is 0. The last two may be equal: a triangle.
  void take(const std::array<std::size_t, 4>& corners);

  // For all s and t of the discs, whose centres must lie in [0, 1].
  [[nodiscard]] Disc value(const Disc& s, const Disc& t) const { return value_of(sum_, s, t); }
  [[nodiscard]] Disc jacobian(const Disc& s, const Disc& t) const { return jacobian_of(sum_, s, t); }
  // Their products (disc_terms.h).
  [[nodiscard]] FourDiscs integrands(const FourDiscs& s, const FourDiscs& t) const { return integrands_of(sum_, s, t); }

 private:
  void add(const Formula& formula, std::size_t part);
  [[nodiscard]] DiscTerm::End end_of(const Formula& formula, const BoundaryPart& part, const End& end) const;
  [[nodiscard]] DiscVec place(const Formula& formula, PointId id) const;

  std::vector<DiscVec> corners_;  // from the first
  DiscVec origin_, normal_;
  DiscSum sum_;
};

// --- Certified integral ---

// The disc on the right that covers half of the ellipse of this rho; its mirror image covers the other half.
[[nodiscard]] Disc cover_of_half_ellipse(double rho);
// A bound of |F times the Jacobian| for one variable in the ellipse about [0, 1], the other one in [0, 1]; infinite
// where the formula may not be analytic there.
enum class Axis { kS, kT };
[[nodiscard]] double bound_on_ellipse(const DiscFormula& formula, Axis axis, double rho);
// Of the rule on [0, 1], for |g| <= bound in the ellipse about it. Requires two nodes or more.
[[nodiscard]] double quadrature_remainder(double bound, double rho, std::size_t nodes);

// In squares of the unit of Point::at; the integral differs from `value` by at most `error`.
struct CertifiedIntegral {
  double value = 0.0;
  double error = 0.0;
  bool is_final = false;  // rounding is most of the error: to cut the cell would not help
};

// The cell's area.
[[nodiscard]] Disc enclosed_area(const Cell& cell, const Plane& receiver);

// Of the formula over the cell, which must be one on which its boundary is proved, or be continued (cell.h).
// Where the tolerance is out of reach, all that is known is 0 <= F <= most: half of that times the area, with this
// error.
[[nodiscard]] CertifiedIntegral certified_integral(const Formula& formula, const Cell& cell, double most,
                                                   double tolerance);

}  // namespace exactff::view_factors
