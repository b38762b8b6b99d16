// Double-double arithmetic with a running bound on its error.
//
// Notation: u = 2^-53; x.hi + x.lo is the value at hand, x.hi the double nearest to it, so that |x.lo| <= u |x.hi|; the
// number it stands for lies within x.error of it. Every operation adds to the bounds that it inherits one of its own,
// derived beside it, in multiples of u^2 = 2^-106. Since the bounds are absolute, they stay true whatever cancels.
//
// Rounding of the bounds. A bound is made of magnitudes and bounds by sums and products alone, so its relative error is
// that of the longest chain of operations on it: below 2^-20 even for a sum of 2^32 terms. A magnitude is taken from
// x.hi alone, which loses u of it; division and square root take the divisor for exact, which by their requirement
// loses 2^-19. Whoever uses a bound in the end makes it larger by kInflation, more than all of this together.
//
// Underflow is gradual. A product of two numbers, or the error of it, that underflows is off by 2^-1074 at most. Each
// bound of a product has kUnderflow added, which is more, also where the product has several terms; a square root, of
// numbers from 2^-900 on, has so much to spare. No operation may overflow: the caller sees to that, or to a result that
// is not finite.
//
// Rounding is to nearest (float_environment.h), and products and sums are never contracted; std::fma is correctly
// rounded with or without hardware for it. The results are the same bits on every machine.
//
// Real is a double, or four of them (reals.h): what is said of a number here is said of each lane. What is declined has
// an infinite error; whatever is made of it has an error that is infinite or NaN, and meets no condition here.
//
// Source of the operations: M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building
// blocks of double-word arithmetic", ACM TOMS 44 (2017); T. Ogita, S. M. Rump, S. Oishi, "Accurate sum and dot
// product", SIAM J. Sci. Comput. 26 (2005).
#pragma once

#include <limits>
#include <type_traits>

#include "kernel/reals.h"

namespace exactff::kernel::double_double {

using reals::both;
using reals::differ;
using reals::either;
using reals::Four;
using reals::FourMask;
using reals::fused;
using reals::in_every_lane;
using reals::in_some_lane;
using reals::larger;
using reals::magnitude;
using reals::root;
using reals::uniform;
using reals::where;

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

// The same in every lane.
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

// The same where |a| >= |b|, or a is a multiple of the last place of b.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> fast_two_sum(const Real& a, const Real& b) {
  const Real sum = a + b;
  return {sum, b - (sum - a)};
}

// a * b, exactly but for underflow.
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

// True where the sign of x is that of x.hi.
template <class Real>
EXACTFF_INLINE auto sign_is_certain(const BasicBounded<Real>& x) {
  return magnitude(x.hi) > 2.0 * x.error;
}

// x + y within 4 u^2 |x + y|, however much cancels (Joldes et al., algorithm 6: 3 u^2 + 13 u^3).
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> accurate_sum(const BasicDoubleDouble<Real>& x,
                                                    const BasicDoubleDouble<Real>& y) {
  const auto s = two_sum(x.hi, y.hi);
  const auto t = two_sum(x.lo, y.lo);
  const auto v = fast_two_sum(s.hi, s.lo + t.hi);
  return fast_two_sum(v.hi, t.lo + v.lo);
}

// Let m = |x.hi| + |y.hi|. The sum of the low parts errs by u (u m), the one after it by u (2 u m): in all below 3.1
// u^2 m; 4 u^2 m is taken. The last step is exact: if x and y cancel by more than half of the larger, x.hi + y.hi is
// exact and a multiple of the last place of what remains, which is at most u m; otherwise it is larger than that.
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

// x y as far as doubles see it: a product and what it lacks, the product of the low parts (u^2 |x.hi y.hi|) apart. With
// m = |x.hi y.hi| the first FMA errs by 2 u^2 m, the second by 3 u^2 m (and u^3 m more in both); |lo| <= 3.1 u m.
template <class Real>
EXACTFF_INLINE BasicDoubleDouble<Real> raw_product(const BasicDoubleDouble<Real>& x, const BasicDoubleDouble<Real>& y) {
  const auto p = two_product(x.hi, y.hi);
  return {p.hi, fused(x.hi, y.lo, fused(x.lo, y.hi, p.lo))};
}

// By raw_product within 6.1 u^2 |x.hi y.hi|; 8 u^2 is taken.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator*(const BasicBounded<Real>& x, const BasicBounded<Real>& y) {
  const auto p = raw_product(parts(x), parts(y));
  const Real inherited = magnitude(x.hi) * y.error + (magnitude(y.hi) + y.error) * x.error;
  return bounded(fast_two_sum(p.hi, p.lo), inherited + 0x1p-103 * magnitude(p.hi) + kUnderflow);
}

// t y for an exact double t. The FMA errs by 2 u^2 |t y|; 4 u^2 is taken.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> operator*(const Real& t, const BasicBounded<Real>& y) {
  const auto p = two_product(t, y.hi);
  return bounded(fast_two_sum(p.hi, fused(t, y.lo, p.lo)),
                 magnitude(t) * y.error + 0x1p-104 * magnitude(p.hi) + kUnderflow);
}

// a b + c d. With m = |a.hi b.hi| + |c.hi d.hi| the two raw products err by 6.1 u^2 m together, what the sum of their
// high parts loses and the sum of the low parts are at most u m and 3.1 u m, so that adding these errs by
// (3.1 + 4.1) u^2 m: 13.3 u^2 m in all; 16 u^2 m = 2^-102 m is left to the caller, and what underflows.
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

// x / y, declined unless |y| >= 2^-900 and y.error is negligible beside y. Let q = x.hi / y.hi rounded. Its remainder
// x.hi - q y.hi is a double, at most u |q y|, and x - q y is at most 3.1 u |q y|. Computed, it errs by 2.1 u^2 |q y| in
// what the low parts add to it and by 3.1 u^2 |q y| in the sum. Then 1 / y.hi for 1 / y, its rounding and that of the
// product err by 3.1 u^2 |q| each. In all below 14.6 u^2 |q|; 16 u^2 |q| is taken.
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

// Declined unless x >= 2^-900 and x.error is negligible beside x. Let s be the root of x.hi, rounded, and x = s^2 (1 +
// d), |d| <= 3.1 u. The remainder x.hi - s^2 is a double; adding x.lo to it errs by 3.1 u^2 s^2, of which the factor
// 1 / 2 s leaves half; that factor and the product with it err by 1.6 u^2 s each; the term -d^2 / 8 left out is below
// 1.3 u^2. In all below 6.1 u^2 s; 8 u^2 s is taken.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> square_root(const BasicBounded<Real>& x) {
  const Real s = root(x.hi);
  const Real half_inverse = 0.5 / s;
  const Real remainder = fused(-s, s, x.hi) + x.lo;
  return only_where(both(x.hi >= 0x1p-900, x.error <= kNegligible * x.hi),
                    bounded(fast_two_sum(s, remainder * half_inverse), x.error * half_inverse + 0x1p-103 * s));
}

}  // namespace exactff::kernel::double_double
