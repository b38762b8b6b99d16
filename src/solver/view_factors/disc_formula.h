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
// affine in x becomes k0 + k2 t + s (k1 + k3 t).
//
// A part of the boundary from P to Q on the line through A and B, with the unit direction l = (B - A) / |B - A|, has
// the term (Eq. (4); F is the sum of the terms, with the opposite sign of the part's)
//
//   T = theta nu / (2 pi d),   nu = n . ((A - x) x l),   d^2 = (A - x)^2 - ((A - x) . l)^2,
//
// d being the distance of x from the line and theta the angle between p = P - x and q = Q - x, negative if P and Q have
// changed places. With D = (Q - P) . l, |p x q| = |D| d. Let R = sqrt(p.p) sqrt(q.q) and A(z) = atan(sqrt z) / sqrt z.
// The tangent of half of theta is D d / (p.q + R) = (R - p.q) / (D d), hence two forms:
//
//   near   T = nu w A(w^2 d^2) / pi,             w = D / (R + p.q);
//   wide   T = h - nu w A(w^2 d^2) / pi,         w = D / (R - p.q),   D > 0,   h = nu / (2 d).
//
// The first is used up to a right angle, the second beyond. An edge in the receiver's plane has |nu| = d, and
// h = 1/2 or -1/2, the sign of nu: then neither form has a singularity but at P and Q and, for the near form, between
// them.
//
// If Q, say, is where the line through C and E, along e, seems to cross the edge: Q = A + (B - A) f,
//   f = (C - x) . (e x (A - C)) / ((C - x) . ((B - A) x e)),
// a quotient of affine functions. So T is made of affine functions of x by rational operations, by roots and by A, and
// analytic wherever these are.
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
#include "view_factors/formula.h"

namespace exactff::view_factors {

// A function k0 + k2 t + s (k1 + k3 t).
struct Bilinear {
  std::array<Disc, 4> k;

  [[nodiscard]] Disc at(const Disc& s, const Disc& t) const { return k[0] + k[2] * t + s * (k[1] + k[3] * t); }
};

class DiscFormula {
 public:
  // Of the cell, or of a single point: a cell of one corner, which is x(0, 0).
  DiscFormula(const Formula& formula, const Cell& cell);

  // Takes the quadrilateral at these corners of the cell; the first is 0. The last two may be equal: a triangle.
  void take(const std::array<std::size_t, 4>& corners);

  // F for all s and t of the discs, whose centres must lie in [0, 1].
  [[nodiscard]] Disc value(const Disc& s, const Disc& t) const;
  [[nodiscard]] Disc jacobian(const Disc& s, const Disc& t) const { return jacobian_.at(s, t); }

 private:
  struct Vectors {
    DiscVec from, gradient;  // the affine function (from - x) . gradient
  };
  struct Crossing {
    Vectors above, below;  // f is their quotient
    Bilinear above_on, below_on;
  };
  // An end: where a line crosses the edge, or its first or second end.
  struct Ending {
    int crossing = -1;
    double fraction = 0.0;
  };
  struct Part {
    Vectors along, across, beyond, height;  // (A - x) . l, by two directions perpendicular to l, and nu
    Bilinear along_on, across_on, beyond_on, height_on;
    Disc size;  // |B - A|
    Ending from, to;
    bool in_receiver_plane = false;
    double sign = 1.0;
    double side = 0.0;  // the sign of nu on the cell, of an edge in the receiver's plane
  };

  void add(const Formula& formula, std::size_t part);
  Ending ending(const Formula& formula, const BoundaryPart& part, const End& end);
  [[nodiscard]] DiscVec place(const Formula& formula, PointId id) const;
  [[nodiscard]] Bilinear on_square(const Vectors& f) const;
  [[nodiscard]] Disc fraction_of(const Ending& end, const Disc& s, const Disc& t) const;
  [[nodiscard]] Disc term(const Part& part, const Disc& s, const Disc& t) const;

  std::vector<DiscVec> corners_;  // from the first
  DiscVec origin_, normal_;
  DiscVec a_, b_, c_;
  Bilinear jacobian_;
  std::vector<Part> parts_;
  double constant_;
  std::vector<Crossing> crossings_;
};

}  // namespace exactff::view_factors
