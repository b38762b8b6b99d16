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
#pragma once

#include <array>
#include <vector>

#include "view_factors/disc_space.h"
#include "view_factors/disc_terms.h"
#include "view_factors/formula.h"

namespace exactff::view_factors {

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

}  // namespace exactff::view_factors
