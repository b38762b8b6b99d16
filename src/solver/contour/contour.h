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
#include "kernel/exact_vec.h"
#include "visibility/boundary_piece.h"

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

}  // namespace exactff::contour
