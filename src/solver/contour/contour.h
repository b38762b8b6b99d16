// Tampieri's Eq. (4) over the boundary of a visible region, in ball arithmetic. This module contains every
// transcendental function.
//
//   F = -1/(2 pi |n|) sum over boundary pieces of  angle(p, q) n . (a x b) / |a x b|
//
// p and q are the ends of the piece, a and b those of its supporting edge, n is the receiver's normal. (The printed
// equation lacks the minus sign that its vertex order needs: erratum.) Source: F. Tampieri, Graphics Gems III (1992),
// after H. C. Hottel and A. F. Sarofim (1967).
//
// With p = l0 a + m0 b and q = l1 a + m1 b,  p x q = w a x b  where w = l0 m1 - m0 l1, so
//   angle = atan2(|w| |a x b|, p . q),  and its term takes the sign of w.
// a x b, p . q, n . (a x b), |a x b|^2 and w are computed exactly, once; balls start where these are rounded. Each term
// therefore has full relative precision for any geometry. Accuracy is lost only by cancellation in the sum, so raising
// the precision by the number of bits lost there gives any desired accuracy.
#pragma once

#include <span>
#include <vector>

#include "kernel/ball.h"
#include "kernel/numbers.h"
#include "visibility/outlines.h"

namespace exactff::contour {

class ContourIntegral {
 public:
  // `normal`: any positive multiple of the receiver's normal; not zero.
  explicit ContourIntegral(kernel::ExactVec3 normal);

  // Requires that a x b is not zero.
  void add(const visibility::BoundaryPiece& piece);

  // Encloses F of the closed loops added so far, computed with `bits` bits.
  [[nodiscard]] Ball evaluate(long bits) const;

 private:
  struct Term {
    kernel::Integer squared_cross;   // |a x b|^2 > 0
    kernel::Integer normal_dot;      // n . (a x b), with the sign of w
    kernel::Integer parameter_span;  // |w|
    kernel::Integer ends_dot;        // p . q
  };

  kernel::ExactVec3 normal_;
  std::vector<Term> terms_;
};

// --- Arc sum ---

// Derivatives of the form factor over the arcs of the visible boundary, in ball arithmetic.
//
// Notation: an arc runs from direction p to direction q, less than a half turn; what is seen lies on its left. It is
// the image of a line in space. With C = p x q, the plane of the arc and x has the inward normal -C. The *nearness* g
// of the line is a vector with g . y = 1 for all its points y, relative to x: in the unit direction w of the arc, the
// point of the line is at the distance r = 1 / (g . w). n is the receiver's normal.
//
// If x moves by d, the arc moves at w by (d . C/|C|) / r along -C/|C|, that is, into what is seen, so that
//   dF/dx = -1/(pi |n|) sum over arcs of  C/|C| I,   I = integral over the arc of (w . n) (w . g).
// For the rest of this comment, let g be its part in the plane of the arc, k = C/|C|, w1 and w2 the unit vectors of p
// and q, theta the angle between them. An arc is w(f) = w1 cos f + (k x w1) sin f, so
//   2 I = theta (n . g) + (w1 . n) (k x w1) . g - (w2 . n) (k x w2) . g,
// where (k x w) . g = k . (w x g). For p and q of any length this is 2 I = theta A + B / |C| with
//   A = n . g - (n . C) (C . g) / |C|^2,   B = (p . n) C . (p x g) / p . p - (q . n) C . (q x g) / q . q.
// A and B are rational. theta = atan2(|C|, p . q). Eq. (4) is F = n . V / |n| with V = -1/(2 pi) sum theta C/|C|.
// Arcs on the horizon contribute nothing to dF/dx whatever their g is, since n . w = 0 there.
// Derivation of the movement: J. Arvo, "The Irradiance Jacobian for Partially Occluded Polyhedral Sources",
// SIGGRAPH '94.

struct MovingArc {
  kernel::ExactVec3 begin, end;
  kernel::RationalVec3 nearness;
};

// Joins arcs of one line where one ends and the next begins: afterwards the arcs depend on the visible region alone.
[[nodiscard]] std::vector<MovingArc> joined(std::vector<MovingArc> arcs);

// 2 I |C| = theta |C| A + B of an arc, as above.
struct ArcIntegral {
  ArcIntegral(const MovingArc& arc, const kernel::ExactVec3& n);
  kernel::ExactVec3 cross;        // C
  kernel::Integer squared_cross;  // |C|^2
  kernel::Integer ends_dot;       // p . q
  kernel::Rational factor, rest;  // A, B
};

// A sum over arcs of  c theta / |C| + rest,  c and rest rational.
class ArcSum {
 public:
  // True if equal terms cancel, so that the sum is exactly 0. False proves nothing.
  [[nodiscard]] bool cancels() const;
  // Encloses the sum, computed with `bits` bits.
  [[nodiscard]] Ball evaluate(long bits) const;

  void add_position(const ArcIntegral& twice, int axis);
  void add_normal(const MovingArc& arc, int axis);
  // weight / |C| 2 I, where the arc's nearness may be any vector.
  void add_weighted(const MovingArc& arc, const kernel::ExactVec3& n, const kernel::Rational& weight);
  // For a movement along d: -(d . C) / |C| 2 I.
  void add_along(const MovingArc& arc, const kernel::ExactVec3& n, const kernel::ExactVec3& d);
  // The same for a gain: |d . C| / |C| 2 I.
  void add_gain(const MovingArc& arc, const kernel::ExactVec3& n, const kernel::ExactVec3& d);

 private:
  struct Term {
    kernel::Integer squared_cross;  // |C|^2 > 0
    kernel::Integer ends_dot;       // p . q
    kernel::Rational factor;        // c
    kernel::Rational rest;
  };
  void add(const ArcIntegral& arc, const kernel::Rational& weight);
  void add(kernel::Integer squared_cross, kernel::Integer ends_dot, kernel::Rational factor, kernel::Rational rest);

  std::vector<Term> terms_;
};

}  // namespace exactff::contour
