// Vectors in double-double (double_double.h), with one bound for the errors of the three components.
#pragma once

#include <array>
#include <cmath>

#include "kernel/double_double.h"

namespace exactff::contour {

using kernel::double_double::BasicBounded;
using kernel::double_double::BasicDoubleDouble;
using kernel::double_double::Four;
using kernel::double_double::kUnderflow;
using kernel::double_double::magnitude;
using kernel::double_double::two_product;
using kernel::double_double::two_sum;
using kernel::double_double::where;

template <class Real>
using Components = std::array<BasicDoubleDouble<Real>, 3>;

template <class Real>
struct BasicVector {
  Components<Real> c;
  Real norm{};   // sum of the magnitudes of the components
  Real error{};  // bound on the error of each component
};

using Vector = BasicVector<double>;
using FourVector = BasicVector<Four>;

// p where the condition holds, else q.
template <class Condition, class Real>
EXACTFF_INLINE BasicVector<Real> where(const Condition& condition, const BasicVector<Real>& p,
                                       const BasicVector<Real>& q) {
  const auto component = [&](int i) -> BasicDoubleDouble<Real> {
    return {where(condition, p.c[i].hi, q.c[i].hi), where(condition, p.c[i].lo, q.c[i].lo)};
  };
  return {
      {component(0), component(1), component(2)}, where(condition, p.norm, q.norm), where(condition, p.error, q.error)};
}

template <class Real>
EXACTFF_INLINE Real norm(const Components<Real>& c) {
  return magnitude(c[0].hi) + magnitude(c[1].hi) + magnitude(c[2].hi);
}

template <class Real>
EXACTFF_INLINE BasicVector<Real> vector(const Components<Real>& c, const Real& error) {
  return {c, norm(c), error};
}

template <class Real>
EXACTFF_INLINE BasicVector<Real> difference(const BasicVector<Real>& p, const BasicVector<Real>& q) {
  const Components<Real> c = {accurate_sum(p.c[0], -q.c[0]), accurate_sum(p.c[1], -q.c[1]),
                              accurate_sum(p.c[2], -q.c[2])};
  return vector(c, p.error + q.error + 0x1p-104 * norm(c) + kUnderflow);
}

// The error that a sum of products of a component of p and a component of q inherits from p and q.
template <class Real>
EXACTFF_INLINE Real inherited_error(const BasicVector<Real>& p, const BasicVector<Real>& q) {
  return (p.norm + 3.0 * p.error) * q.error + q.norm * p.error;
}

template <class Real>
EXACTFF_INLINE BasicVector<Real> cross(const BasicVector<Real>& p, const BasicVector<Real>& q) {
  return vector({sum_of_products(p.c[1], q.c[2], -p.c[2], q.c[1]), sum_of_products(p.c[2], q.c[0], -p.c[0], q.c[2]),
                 sum_of_products(p.c[0], q.c[1], -p.c[1], q.c[0])},
                inherited_error(p, q) + 0x1p-102 * (p.norm * q.norm) + kUnderflow);
}

// l p + m q.
template <class Real>
EXACTFF_INLINE BasicVector<Real> combination(const BasicBounded<Real>& l, const BasicVector<Real>& p,
                                             const BasicBounded<Real>& m, const BasicVector<Real>& q) {
  const auto s = parts(l), t = parts(m);
  const Real inherited = magnitude(l.hi) * p.error + (p.norm + p.error) * l.error + magnitude(m.hi) * q.error +
                         (q.norm + q.error) * m.error;
  return vector({sum_of_products(s, p.c[0], t, q.c[0]), sum_of_products(s, p.c[1], t, q.c[1]),
                 sum_of_products(s, p.c[2], t, q.c[2])},
                inherited + 0x1p-102 * (magnitude(l.hi) * p.norm + magnitude(m.hi) * q.norm) + kUnderflow);
}

// Let m be the sum of the magnitudes of the three products. The raw products are wrong by 6.1 u^2 m. The sums of high
// parts leave 2.1 u m to the low parts, which are 3.1 u m themselves. Adding these low parts is wrong by (3.1 + 3.1 +
// 2.1 + 5.2) u^2 m. The total is below 20 u^2 m; 32 u^2 m is used.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> dot(const BasicVector<Real>& p, const BasicVector<Real>& q) {
  const auto x = raw_product(p.c[0], q.c[0]);
  const auto y = raw_product(p.c[1], q.c[1]);
  const auto z = raw_product(p.c[2], q.c[2]);
  const auto s = two_sum(x.hi, y.hi);
  const auto t = two_sum(s.hi, z.hi);
  const Real rest = ((x.lo + y.lo) + z.lo) + (s.lo + t.lo);
  const Real size = magnitude(x.hi) + magnitude(y.hi) + magnitude(z.hi);
  return bounded(two_sum(t.hi, rest), inherited_error(p, q) + 0x1p-101 * size + kUnderflow);
}

// p - t q for an exact double t, for the case that p and t q nearly cancel. Let m = |p.hi| + |t q.hi| for a component.
// The parts that are added as doubles are together at most 4 u^2 m, so adding them is wrong by 7 u^3 m. Used is
// 8 u^3 m = 2^-156 m. The last sum is wrong by 4 u^2 of the result.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> near_cancellation(const BasicDoubleDouble<Real>& p, const Real& t,
                                                         const BasicDoubleDouble<Real>& q) {
  const auto high = two_product(-t, q.hi);
  const auto low = two_product(-t, q.lo);
  const auto v = two_sum(p.lo, high.lo);
  const auto w = two_sum(v.hi, low.hi);
  return accurate_sum(two_sum(p.hi, high.hi), two_sum(w.hi, (v.lo + w.lo) + low.lo));
}

template <class Real>
EXACTFF_INLINE BasicVector<Real> near_cancellation(const BasicVector<Real>& p, const Real& t,
                                                   const BasicVector<Real>& q) {
  const Components<Real> c = {near_cancellation(p.c[0], t, q.c[0]), near_cancellation(p.c[1], t, q.c[1]),
                              near_cancellation(p.c[2], t, q.c[2])};
  const Real size = magnitude(t);
  return vector(c, p.error + size * q.error + 0x1p-104 * norm(c) + 0x1p-156 * (p.norm + size * q.norm) + kUnderflow);
}

}  // namespace exactff::contour
