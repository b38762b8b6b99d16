// Double-double arithmetic with a running bound on its error.
//
// Notation: u = 2^-53. x.hi + x.lo is the computed value, where x.hi is the double nearest to it, so that
// |x.lo| <= u |x.hi|. The exact number that it represents lies within x.error of it. Every operation adds its own error
// bound to the bounds that it inherits. Its own bound is derived beside it, in multiples of u^2 = 2^-106. Since the
// bounds are absolute, they stay valid under any cancellation.
//
// Rounding of the bounds. A bound is computed from magnitudes and bounds by sums and products alone, so its relative
// error is that of the longest chain of operations on it: below 2^-20 even for a sum of 2^32 terms. A magnitude is
// taken from x.hi alone, which loses u of it. Division and square root treat the divisor as exact, which by their
// requirement loses 2^-19. At the end, the user of a bound multiplies it by kInflation, which exceeds all of this
// together.
//
// Underflow is gradual. If a product of two numbers, or its error term, underflows, it is wrong by at most 2^-1074.
// Each bound of a product has kUnderflow added, which is larger, also if the product has several terms. The bound of a
// square root, of numbers from 2^-900 on, has enough margin for this. No operation may overflow: the caller must
// prevent this, or check that the result is finite.
//
// Rounding is to nearest (float_environment.h), and products and sums are never contracted. std::fma is correctly
// rounded with or without hardware support. The results have the same bits on every machine.
//
// Real is a double or four doubles (reals.h). With four, every statement about a number holds for each lane. A declined
// result has an infinite error. Everything computed from it has an error that is infinite or NaN, and fails every
// condition here.
//
// Source of the operations: M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building
// blocks of double-word arithmetic", ACM TOMS 44 (2017); T. Ogita, S. M. Rump, S. Oishi, "Accurate sum and dot
// product", SIAM J. Sci. Comput. 26 (2005).
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "kernel/reals.h"

namespace exactff::kernel::double_double {

template <class Real>
struct BasicDoubleDouble {
  Real hi{};
  Real lo{};
};

template <class Real>
struct BasicBounded {
  Real hi{};
  Real lo{};
  Real error{};
};

using DoubleDouble = BasicDoubleDouble<double>;
using Bounded = BasicBounded<double>;
using FourBounded = BasicBounded<Four>;

inline constexpr double kUnderflow = 0x1p-1000;
inline constexpr double kInflation = 1.001;
inline constexpr double kNegligible = 0x1p-20;
inline constexpr Bounded kDeclined{0.0, 0.0, std::numeric_limits<double>::infinity()};

// The same number in every lane.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> uniform(const Bounded& x) {
  return {uniform<Real>(x.hi), uniform<Real>(x.lo), uniform<Real>(x.error)};
}

// x where the condition holds, else y.
template <class Condition, class Real>
EXACTFF_INLINE BasicBounded<Real> where(const Condition& condition, const BasicBounded<Real>& x,
                                        const BasicBounded<Real>& y) {
  return {where(condition, x.hi, y.hi), where(condition, x.lo, y.lo), where(condition, x.error, y.error)};
}
// x where the condition holds, else declined.
template <class Condition, class Real>
EXACTFF_INLINE BasicBounded<Real> only_where(const Condition& condition, const BasicBounded<Real>& x) {
  return where(condition, x, uniform<Real>(kDeclined));
}

template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> parts(const BasicBounded<Real>& x) {
  return {x.hi, x.lo};
}

// a + b, exactly.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> two_sum(const Real& a, const Real& b) {
  const Real sum = a + b;
  const Real b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// a + b, exactly. Requires |a| >= |b|, or that a is a multiple of the last place of b, as the bounds beside
// its uses show.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> fast_two_sum(const Real& a, const Real& b) {
  const Real sum = a + b;
  return {sum, b - (sum - a)};
}

// a * b, exact except for underflow.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> two_product(const Real& a, const Real& b) {
  const Real product = a * b;
  return {product, fused(a, b, -product)};
}

template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> operator-(const BasicDoubleDouble<Real>& x) {
  return {-x.hi, -x.lo};
}
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator-(const BasicBounded<Real>& x) {
  return {-x.hi, -x.lo, x.error};
}

template <class Real>
EXACTFF_INLINE BasicBounded<Real> bounded(const BasicDoubleDouble<Real>& x, const std::type_identity_t<Real>& error) {
  return {x.hi, x.lo, error};
}

// True if the sign of x is certainly that of x.hi.
template <class Real>
EXACTFF_INLINE auto sign_is_certain(const BasicBounded<Real>& x) {
  return magnitude(x.hi) > 2.0 * x.error;
}

// x + y with an error of at most 4 u^2 |x + y| under any cancellation (Joldes et al., algorithm 6: 3 u^2 + 13 u^3).
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> accurate_sum(const BasicDoubleDouble<Real>& x,
                                                    const BasicDoubleDouble<Real>& y) {
  const auto s = two_sum(x.hi, y.hi);
  const auto t = two_sum(x.lo, y.lo);
  const auto v = fast_two_sum(s.hi, s.lo + t.hi);
  return fast_two_sum(v.hi, t.lo + v.lo);
}

// Let m = |x.hi| + |y.hi|. The sum of the low parts is wrong by u (u m), the next one by u (2 u m). The total is below
// 3.1 u^2 m; 4 u^2 m is used. The last step is exact: if x and y cancel by more than half of the larger one,
// x.hi + y.hi is exact and a multiple of the last place of the rest, which is at most u m; otherwise it is larger than
// the rest.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator+(const BasicBounded<Real>& x, const BasicBounded<Real>& y) {
  const auto s = two_sum(x.hi, y.hi);
  const Real rest = s.lo + (x.lo + y.lo);
  return bounded(fast_two_sum(s.hi, rest), x.error + y.error + 0x1p-104 * (magnitude(x.hi) + magnitude(y.hi)));
}
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator-(const BasicBounded<Real>& x, const BasicBounded<Real>& y) {
  return x + -y;
}

// x y without the product of the low parts (u^2 |x.hi y.hi|): a rounded product and its rest. Let m = |x.hi y.hi|. The
// first FMA is wrong by 2 u^2 m, the second by 3 u^2 m (and both by another u^3 m); |lo| <= 3.1 u m.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> raw_product(const BasicDoubleDouble<Real>& x, const BasicDoubleDouble<Real>& y) {
  const auto p = two_product(x.hi, y.hi);
  return {p.hi, fused(x.hi, y.lo, fused(x.lo, y.hi, p.lo))};
}

// By raw_product, within 6.1 u^2 |x.hi y.hi|; 8 u^2 is used.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator*(const BasicBounded<Real>& x, const BasicBounded<Real>& y) {
  const auto p = raw_product(parts(x), parts(y));
  const Real inherited = magnitude(x.hi) * y.error + (magnitude(y.hi) + y.error) * x.error;
  return bounded(fast_two_sum(p.hi, p.lo), inherited + 0x1p-103 * magnitude(p.hi) + kUnderflow);
}

// t y for an exact double t. The FMA is wrong by 2 u^2 |t y|; 4 u^2 is used.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator*(const Real& t, const BasicBounded<Real>& y) {
  const auto p = two_product(t, y.hi);
  return bounded(fast_two_sum(p.hi, fused(t, y.lo, p.lo)),
                 magnitude(t) * y.error + 0x1p-104 * magnitude(p.hi) + kUnderflow);
}

// a b + c d. Let m = |a.hi b.hi| + |c.hi d.hi|. The two raw products together are wrong by 6.1 u^2 m. The rounding
// error of the sum of their high parts and the sum of their low parts are at most u m and 3.1 u m, so adding these is
// wrong by (3.1 + 4.1) u^2 m. The total is 13.3 u^2 m. The caller must add 16 u^2 m = 2^-102 m, and the underflow.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> sum_of_products(const BasicDoubleDouble<Real>& a,
                                                       const BasicDoubleDouble<Real>& b,
                                                       const BasicDoubleDouble<Real>& c,
                                                       const BasicDoubleDouble<Real>& d) {
  const auto p = raw_product(a, b);
  const auto q = raw_product(c, d);
  const auto s = two_sum(p.hi, q.hi);
  return two_sum(s.hi, s.lo + (p.lo + q.lo));
}

template <class Real>
EXACTFF_INLINE BasicBounded<Real> sum_of_products(const BasicBounded<Real>& a, const BasicBounded<Real>& b,
                                                  const BasicBounded<Real>& c, const BasicBounded<Real>& d) {
  const auto sum = sum_of_products(parts(a), parts(b), parts(c), parts(d));
  const Real inherited = magnitude(a.hi) * b.error + (magnitude(b.hi) + b.error) * a.error + magnitude(c.hi) * d.error +
                         (magnitude(d.hi) + d.error) * c.error;
  return bounded(sum, inherited + 0x1p-102 * (magnitude(a.hi * b.hi) + magnitude(c.hi * d.hi)) + kUnderflow);
}

// x / y. Declined unless |y| >= 2^-900 and y.error is negligible beside y. Let q = x.hi / y.hi, rounded. Its remainder
// x.hi - q y.hi is a double of at most u |q y|, and x - q y is at most 3.1 u |q y|. The computed remainder is wrong by
// 2.1 u^2 |q y| in the contribution of the low parts and by 3.1 u^2 |q y| in the sum. Using 1 / y.hi for 1 / y, its
// rounding and that of the product are each wrong by 3.1 u^2 |q|. The total is below 14.6 u^2 |q|; 16 u^2 |q| is used.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator/(const BasicBounded<Real>& x, const BasicBounded<Real>& y) {
  const Real size = magnitude(y.hi);
  const Real inverse = 1.0 / y.hi;
  const Real q = x.hi / y.hi;
  const Real remainder = fused(-q, y.hi, x.hi) + fused(-q, y.lo, x.lo);
  const Real inherited = (x.error + magnitude(q) * y.error + kUnderflow) * magnitude(inverse);
  return only_where(both(size >= 0x1p-900, y.error <= kNegligible * size),
                    bounded(fast_two_sum(q, remainder * inverse), inherited + 0x1p-102 * magnitude(q) + kUnderflow));
}

// The square root of x. Declined unless x >= 2^-900 and x.error is negligible beside x. Let s be the root of x.hi,
// rounded, and x = s^2 (1 + d), |d| <= 3.1 u. The remainder x.hi - s^2 is a double. Adding x.lo to it is wrong by
// 3.1 u^2 s^2, of which the factor 1 / 2 s leaves half. That factor and the product with it are wrong by 1.6 u^2 s
// each. The omitted term -d^2 / 8 is below 1.3 u^2. The total is below 6.1 u^2 s; 8 u^2 s is used.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> square_root(const BasicBounded<Real>& x) {
  const Real s = root(x.hi);
  const Real half_inverse = 0.5 / s;
  const Real remainder = fused(-s, s, x.hi) + x.lo;
  return only_where(both(x.hi >= 0x1p-900, x.error <= kNegligible * x.hi),
                    bounded(fast_two_sum(s, remainder * half_inverse), x.error * half_inverse + 0x1p-103 * s));
}

// The double nearest to x if the error leaves no doubt. Adding a bound to x.lo is rounded to within u of the result,
// which is far below the 2^-50 of x.lo and the share of the error that are added.
inline std::optional<double> nearest(const Bounded& x) {
  const double error = x.error * (1.0 + 0x1p-10) + 0x1p-50 * std::abs(x.lo);
  const double low = x.hi + (x.lo - error), high = x.hi + (x.lo + error);
  if (!std::isfinite(low) || low != high) return std::nullopt;
  return low == 0.0 ? 0.0 : low;
}

}  // namespace exactff::kernel::double_double
