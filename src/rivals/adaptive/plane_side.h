// Tests for sides of planes, used to set up one receiver: sums of products with a bound on their rounding error.
//
// Notation: u = 2^-53. Inputs are differences of points, within relative error u a component. A component of a cross
// product errs by at most 4u of its magnitude (the sum of the magnitudes of its two products), a dot product with it by
// less than 9u of its own magnitude; the bound used is 32u. Every product with a zero factor has magnitude 0, and every
// other at least 2^-400, far above the effect of underflow in coordinates of about 1. So an axis-parallel plane gets
// the bound 0 and is decided like the others, without an exact sign.
#pragma once

#include "adaptive/vec.h"

namespace exactff::adaptive {

struct Bounded {
  double value = 0.0;
  double error = 0.0;

  [[nodiscard]] bool certainly_positive() const { return value > error; }
  [[nodiscard]] bool certainly_negative() const { return value < -error; }
  [[nodiscard]] bool certainly_not_positive() const { return value <= -error; }
  [[nodiscard]] bool certainly_zero() const { return value == 0.0 && error == 0.0; }
};

// A normal and the magnitudes of its components' terms.
struct Normal {
  Vec3 value;
  Vec3 magnitude;
};

// (b - a) x (c - a): points to the side from which a, b, c run counter-clockwise.
[[nodiscard]] Normal plane_normal(const Vec3& a, const Vec3& b, const Vec3& c);
// The given vector as a normal, without error.
[[nodiscard]] Normal exact_normal(const Vec3& n);

[[nodiscard]] Bounded bounded_dot(const Normal& n, const Vec3& d);

}  // namespace exactff::adaptive
