// Vectors and angles in double-double (double_double.h).
#pragma once

#include <array>
#include <cmath>

#include "kernel/double_double.h"

namespace exactff::kernel::double_double {

template <class Real>
using Components = std::array<BasicDoubleDouble<Real>, 3>;

// With one bound for the errors of the three components.
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

// --- Angles ---

inline constexpr int kAtanSteps = 256;  // intervals of the table from 0 to 1

// Each has a relative error of at most 2^-106.
struct AngleConstants {
  std::array<DoubleDouble, kAtanSteps + 1> atan;  // atan of k / kAtanSteps; exactly 0 for k = 0
  DoubleDouble half_pi;
  DoubleDouble pi;
};

// Computed in ball arithmetic on first use.
const AngleConstants& angle_constants();

EXACTFF_INLINE Bounded constant(const DoubleDouble& x) { return {x.hi, x.lo, 0x1p-106 * x.hi}; }

// Entry k of the table. Requires a whole number k from 0 to kAtanSteps: atan_of_ratio rounds one in this range.
EXACTFF_INLINE Bounded tabulated_atan(double k, const AngleConstants& known) {
  return constant(known.atan[static_cast<std::size_t>(k)]);
}
EXACTFF_INLINE FourBounded tabulated_atan(const Four& k, const AngleConstants& known) {
  const auto at = [&](int lane) -> const DoubleDouble& { return known.atan[static_cast<std::size_t>(k[lane])]; };
  const DoubleDouble &a = at(0), &b = at(1), &c = at(2), &d = at(3);
  const Four hi{a.hi, b.hi, c.hi, d.hi};
  return {hi, Four{a.lo, b.lo, c.lo, d.lo}, 0x1p-106 * hi};
}

// atan(z) for |z| < 2^-8.9, where w = z^2 < 2^-17.8:  z (1 + w (-1/3 + w (1/5 - w (1/7 - w (1/9 - w / 11))))).
// All errors here are relative to |z|. The omitted rest of the series is below w^6 / 13 < 2^-92 w. The bracket that
// starts with 1/7, and its product with w, are computed in doubles, from the high part of w alone: the product is wrong
// by less than 2^-53 w, which gives 2^-53 w^3 < 2^-88 w. With low parts of up to 8 u, the double-double operations
// before the last sum are wrong by less than 2^-100 w, and that sum by 3.1 u^2. With w < 2^-17.8 the total is below
// (2^-103 + 2^-87 w).
template <class Real>
EXACTFF_INLINE BasicBounded<Real> atan_near_zero(const BasicBounded<Real>& z) {
  constexpr DoubleDouble kMinusThird{-0x1.5555555555555p-2, -0x1.5555555555555p-56};
  constexpr DoubleDouble kFifth{0x1.999999999999ap-3, -0x1.999999999999ap-57};
  constexpr double kSeventh = 0.14285714285714286, kNinth = 0.1111111111111111, kEleventh = 0.09090909090909091;
  const auto square = raw_product(parts(z), parts(z));
  const Real& w = square.hi;
  const auto second = fast_two_sum(uniform<Real>(kFifth.hi), w * (w * (kNinth - w * kEleventh) - kSeventh));
  const auto tail = raw_product(square, {second.hi, second.lo + kFifth.lo});
  const auto first = fast_two_sum(uniform<Real>(kMinusThird.hi), tail.hi);
  const auto r = raw_product(square, {first.hi, first.lo + (tail.lo + kMinusThird.lo)});
  const auto rz = raw_product(r, parts(z));
  const auto sum = fast_two_sum(z.hi, rz.hi);
  return bounded(fast_two_sum(sum.hi, sum.lo + (rz.lo + z.lo)),
                 z.error + (0x1p-103 + 0x1p-87 * w) * magnitude(z.hi) + kUnderflow);
}

// The whole number nearest to a. Requires 0 <= a < 2^51.
template <class Real>
EXACTFF_INLINE Real nearest_whole(const Real& a) {
  return (a + 0x1p52) - 0x1p52;
}

// atan(y / x) for 0 <= y <= x, up to their errors; declined otherwise. With t = k / kAtanSteps nearest to y / x,
//   atan(y / x) = atan(t) + atan(z),  z = (y - t x) / (x + t y),
// where |z| <= (1 / 2 kAtanSteps) (1 + 2^-40), up to errors that are negligible beside x.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> atan_of_ratio(const BasicBounded<Real>& y, const BasicBounded<Real>& x,
                                                const AngleConstants& known) {
  const Real ratio = y.hi / x.hi;
  const auto is_proper = both(ratio >= 0.0, ratio <= 1.0);  // false for NaN
  const Real k = nearest_whole(Real(kAtanSteps * where(is_proper, ratio, Real{})));
  const Real t = k * (1.0 / kAtanSteps);
  return only_where(is_proper, tabulated_atan(k, known) + atan_near_zero((y - t * x) / (x + t * y)));
}

template <class Real>
EXACTFF_INLINE BasicBounded<Real> negated_where(const auto& condition, const BasicBounded<Real>& x) {
  return where(condition, -x, x);
}

template <class Real>
EXACTFF_INLINE BasicBounded<Real> absolute(const BasicBounded<Real>& x) {
  return negated_where(x.hi < 0.0, x);
}

// The angle of the point (cosine, sine) from the first axis, in (-pi, pi). Declined if the point may be the origin or
// on the negative axis. Let x be the larger of |cosine| and |sine|, and y the other. Up to the sign of the sine, the
// angle is
//   0 + atan(y / x), pi / 2 - atan(y / x), pi / 2 + atan(y / x) or pi - atan(y / x),  depending on the octant.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> atan2(const BasicBounded<Real>& sine, const BasicBounded<Real>& cosine,
                                        const AngleConstants& known) {
  const auto s = absolute(sine), c = absolute(cosine);
  const auto steep = c.hi < s.hi, obtuse = cosine.hi < 0.0;
  const auto x = where(steep, s, c), y = where(steep, c, s);
  const auto is_off_origin =
      both(both(x.hi >= 0x1p-600, x.hi <= 0x1p900), both(y.error <= kNegligible * x.hi, x.error <= kNegligible * x.hi));
  const auto is_off_axis = either(either(steep, cosine.hi >= 0.0), sign_is_certain(sine));
  const auto half_pi = uniform<Real>(constant(known.half_pi)), pi = uniform<Real>(constant(known.pi));
  const auto base = where(steep, half_pi, where(obtuse, pi, BasicBounded<Real>{}));
  const auto angle = base + negated_where(differ(steep, obtuse), atan_of_ratio(y, x, known));
  return only_where(both(is_off_origin, is_off_axis), negated_where(sine.hi < 0.0, angle));
}

}  // namespace exactff::kernel::double_double
