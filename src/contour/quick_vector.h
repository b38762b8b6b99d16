// Vectors in double-double (double_double.h), with one bound for the errors of the three components.
#pragma once

#include <array>
#include <cmath>

#include "kernel/double_double.h"

namespace exactff::contour {

using namespace kernel::double_double;

struct Vector {
  std::array<DoubleDouble, 3> c;
  double norm = 0.0;   // sum of the magnitudes of the components
  double error = 0.0;  // of each component
};

EXACTFF_INLINE double norm(const std::array<DoubleDouble, 3>& c) {
  return std::abs(c[0].hi) + std::abs(c[1].hi) + std::abs(c[2].hi);
}

EXACTFF_INLINE Vector vector(const std::array<DoubleDouble, 3>& c, double error) { return {c, norm(c), error}; }

EXACTFF_INLINE Vector difference(const Vector& p, const Vector& q) {
  const std::array<DoubleDouble, 3> c = {accurate_sum(p.c[0], -q.c[0]), accurate_sum(p.c[1], -q.c[1]),
                                         accurate_sum(p.c[2], -q.c[2])};
  return vector(c, p.error + q.error + 0x1p-104 * norm(c) + kUnderflow);
}

// What is inherited by a sum of products of one component of p and one of q each.
EXACTFF_INLINE double inherited(const Vector& p, const Vector& q) {
  return (p.norm + 3.0 * p.error) * q.error + q.norm * p.error;
}

EXACTFF_INLINE Vector cross(const Vector& p, const Vector& q) {
  return vector({sum_of_products(p.c[1], q.c[2], -p.c[2], q.c[1]), sum_of_products(p.c[2], q.c[0], -p.c[0], q.c[2]),
                 sum_of_products(p.c[0], q.c[1], -p.c[1], q.c[0])},
                inherited(p, q) + 0x1p-102 * (p.norm * q.norm) + kUnderflow);
}

// l p + m q.
EXACTFF_INLINE Vector combination(const Bounded& l, const Vector& p, const Bounded& m, const Vector& q) {
  const DoubleDouble s{l.hi, l.lo};
  const DoubleDouble t{m.hi, m.lo};
  const double inherited =
      std::abs(l.hi) * p.error + (p.norm + p.error) * l.error + std::abs(m.hi) * q.error + (q.norm + q.error) * m.error;
  return vector({sum_of_products(s, p.c[0], t, q.c[0]), sum_of_products(s, p.c[1], t, q.c[1]),
                 sum_of_products(s, p.c[2], t, q.c[2])},
                inherited + 0x1p-102 * (std::abs(l.hi) * p.norm + std::abs(m.hi) * q.norm) + kUnderflow);
}

// With m the sum of the magnitudes of the three products, the raw products err by 6.1 u^2 m, high parts in the sums
// leave 2.1 u m to the low ones, which are 3.1 u m themselves; adding these errs by (3.1 + 3.1 + 2.1 + 5.2) u^2 m. In
// all below 20 u^2 m; 32 u^2 m is taken.
EXACTFF_INLINE Bounded dot(const Vector& p, const Vector& q) {
  const DoubleDouble x = raw_product(p.c[0], q.c[0]);
  const DoubleDouble y = raw_product(p.c[1], q.c[1]);
  const DoubleDouble z = raw_product(p.c[2], q.c[2]);
  const DoubleDouble s = two_sum(x.hi, y.hi);
  const DoubleDouble t = two_sum(s.hi, z.hi);
  const double rest = ((x.lo + y.lo) + z.lo) + (s.lo + t.lo);
  const double size = std::abs(x.hi) + std::abs(y.hi) + std::abs(z.hi);
  return bounded(two_sum(t.hi, rest), inherited(p, q) + 0x1p-101 * size + kUnderflow);
}

// p x q, equal to p x (q - p) and q x (q - p).
EXACTFF_INLINE Vector cross_of_edge(const Vector& p, const Vector& q) {
  return cross(p.norm <= q.norm ? p : q, difference(q, p));
}

// p - t q for an exact double t, where p and t q nearly cancel. With m = |p.hi| + |t q.hi| of a component, the parts
// that are summed as doubles are together at most 4 u^2 m, so that summing them errs by 7 u^3 m; 8 u^3 m = 2^-156 m is
// taken. The last sum errs by 4 u^2 of the result.
EXACTFF_INLINE DoubleDouble near_cancellation(const DoubleDouble& p, double t, const DoubleDouble& q) {
  const DoubleDouble high = two_product(-t, q.hi);
  const DoubleDouble low = two_product(-t, q.lo);
  const DoubleDouble v = two_sum(p.lo, high.lo);
  const DoubleDouble w = two_sum(v.hi, low.hi);
  return accurate_sum(two_sum(p.hi, high.hi), two_sum(w.hi, (v.lo + w.lo) + low.lo));
}

EXACTFF_INLINE Vector near_cancellation(const Vector& p, double t, const Vector& q) {
  const std::array<DoubleDouble, 3> c = {near_cancellation(p.c[0], t, q.c[0]), near_cancellation(p.c[1], t, q.c[1]),
                                         near_cancellation(p.c[2], t, q.c[2])};
  const double size = std::abs(t);
  return vector(c, p.error + size * q.error + 0x1p-104 * norm(c) + 0x1p-156 * (p.norm + size * q.norm) + kUnderflow);
}

}  // namespace exactff::contour
