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
// Underflow. A product of two numbers, or the error of it, that underflows is off by 2^-1074 at most. Each bound of a
// product has kUnderflow added, which is more, also where the product has several terms. No operation may overflow: the
// caller sees to that, or to a result that is not finite.
//
// Rounding is to nearest, and products and sums are never contracted; std::fma is correctly rounded with or without
// hardware for it. The results are the same bits on every machine.
//
// Source of the operations: M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building
// blocks of double-word arithmetic", ACM TOMS 44 (2017); T. Ogita, S. M. Rump, S. Oishi, "Accurate sum and dot
// product", SIAM J. Sci. Comput. 26 (2005).
#pragma once

#include <cmath>
#include <limits>

// std::fma is a function of the library without hardware FMA and one instruction with it. Functions marked
// EXACTFF_FMA_CLONES are compiled for both and chosen at load time; they give the same bits. What they call is inlined
// into both.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
#define EXACTFF_FMA_CLONES __attribute__((target_clones("fma", "default")))
#else
#define EXACTFF_FMA_CLONES
#endif
#define EXACTFF_INLINE [[gnu::always_inline]] inline

namespace exactff::kernel::double_double {

struct DoubleDouble {
  double hi = 0.0;
  double lo = 0.0;
};

struct Bounded {
  double hi = 0.0;
  double lo = 0.0;
  double error = 0.0;
};

inline constexpr double kUnderflow = 0x1p-1000;
inline constexpr double kInflation = 1.001;
inline constexpr double kNegligible = 0x1p-20;
inline constexpr Bounded kDeclined{0.0, 0.0, std::numeric_limits<double>::infinity()};

// a + b, exactly.
EXACTFF_INLINE DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// The same where |a| >= |b|, or a is a multiple of the last place of b.
EXACTFF_INLINE DoubleDouble fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

// a * b, exactly but for underflow.
EXACTFF_INLINE DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

EXACTFF_INLINE DoubleDouble operator-(const DoubleDouble& x) { return {-x.hi, -x.lo}; }
EXACTFF_INLINE Bounded operator-(const Bounded& x) { return {-x.hi, -x.lo, x.error}; }

EXACTFF_INLINE Bounded bounded(const DoubleDouble& x, double error) { return {x.hi, x.lo, error}; }

// True where the sign of x is that of x.hi.
EXACTFF_INLINE bool sign_is_certain(const Bounded& x) { return std::abs(x.hi) > 2.0 * x.error; }

// x + y within 4 u^2 |x + y|, however much cancels (Joldes et al., algorithm 6: 3 u^2 + 13 u^3).
EXACTFF_INLINE DoubleDouble accurate_sum(const DoubleDouble& x, const DoubleDouble& y) {
  const DoubleDouble s = two_sum(x.hi, y.hi);
  const DoubleDouble t = two_sum(x.lo, y.lo);
  const DoubleDouble v = fast_two_sum(s.hi, s.lo + t.hi);
  return fast_two_sum(v.hi, t.lo + v.lo);
}

// Let m = |x.hi| + |y.hi|. The sum of the low parts errs by u (u m), the one after it by u (2 u m): in all below 3.1
// u^2 m; 4 u^2 m is taken. The last step is exact: if x and y cancel by more than half of the larger, x.hi + y.hi is
// exact and a multiple of the last place of what remains, which is at most u m; otherwise it is larger than that.
EXACTFF_INLINE Bounded operator+(const Bounded& x, const Bounded& y) {
  const DoubleDouble s = two_sum(x.hi, y.hi);
  const double rest = s.lo + (x.lo + y.lo);
  return bounded(fast_two_sum(s.hi, rest), x.error + y.error + 0x1p-104 * (std::abs(x.hi) + std::abs(y.hi)));
}
EXACTFF_INLINE Bounded operator-(const Bounded& x, const Bounded& y) { return x + -y; }

// x y as far as doubles see it: a product and what it lacks, the product of the low parts (u^2 |x.hi y.hi|) apart. With
// m = |x.hi y.hi| the first FMA errs by 2 u^2 m, the second by 3 u^2 m (and u^3 m more in both); |lo| <= 3.1 u m.
EXACTFF_INLINE DoubleDouble raw_product(const DoubleDouble& x, const DoubleDouble& y) {
  const DoubleDouble p = two_product(x.hi, y.hi);
  return {p.hi, std::fma(x.hi, y.lo, std::fma(x.lo, y.hi, p.lo))};
}

// By raw_product within 6.1 u^2 |x.hi y.hi|; 8 u^2 is taken.
EXACTFF_INLINE Bounded operator*(const Bounded& x, const Bounded& y) {
  const DoubleDouble p = raw_product({x.hi, x.lo}, {y.hi, y.lo});
  const double inherited = std::abs(x.hi) * y.error + (std::abs(y.hi) + y.error) * x.error;
  return bounded(fast_two_sum(p.hi, p.lo), inherited + 0x1p-103 * std::abs(p.hi) + kUnderflow);
}

// t y for an exact double t. The FMA errs by 2 u^2 |t y|; 4 u^2 is taken.
EXACTFF_INLINE Bounded operator*(double t, const Bounded& y) {
  const DoubleDouble p = two_product(t, y.hi);
  return bounded(fast_two_sum(p.hi, std::fma(t, y.lo, p.lo)),
                 std::abs(t) * y.error + 0x1p-104 * std::abs(p.hi) + kUnderflow);
}

// a b + c d. With m = |a.hi b.hi| + |c.hi d.hi| the two raw products err by 6.1 u^2 m together, what the sum of their
// high parts loses and the sum of the low parts are at most u m and 3.1 u m, so that adding these errs by
// (3.1 + 4.1) u^2 m: 13.3 u^2 m in all; 16 u^2 m = 2^-102 m is left to the caller, and what underflows.
EXACTFF_INLINE DoubleDouble sum_of_products(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                                            const DoubleDouble& d) {
  const DoubleDouble p = raw_product(a, b);
  const DoubleDouble q = raw_product(c, d);
  const DoubleDouble s = two_sum(p.hi, q.hi);
  return two_sum(s.hi, s.lo + (p.lo + q.lo));
}

EXACTFF_INLINE Bounded sum_of_products(const Bounded& a, const Bounded& b, const Bounded& c, const Bounded& d) {
  const DoubleDouble sum = sum_of_products(DoubleDouble{a.hi, a.lo}, {b.hi, b.lo}, {c.hi, c.lo}, {d.hi, d.lo});
  const double inherited = std::abs(a.hi) * b.error + (std::abs(b.hi) + b.error) * a.error + std::abs(c.hi) * d.error +
                           (std::abs(d.hi) + d.error) * c.error;
  return bounded(sum, inherited + 0x1p-102 * (std::abs(a.hi * b.hi) + std::abs(c.hi * d.hi)) + kUnderflow);
}

// x / y, declined unless |y| >= 2^-900 and y.error is negligible beside y. Let q = x.hi / y.hi rounded. Its remainder
// x.hi - q y.hi is a double, at most u |q y|, and x - q y is at most 3.1 u |q y|. Computed, it errs by 2.1 u^2 |q y| in
// what the low parts add to it and by 3.1 u^2 |q y| in the sum. Then 1 / y.hi for 1 / y, its rounding and that of the
// product err by 3.1 u^2 |q| each. In all below 14.6 u^2 |q|; 16 u^2 |q| is taken.
EXACTFF_INLINE Bounded operator/(const Bounded& x, const Bounded& y) {
  const double size = std::abs(y.hi);
  if (!(size >= 0x1p-900 && y.error <= kNegligible * size)) return kDeclined;
  const double inverse = 1.0 / y.hi;
  const double q = x.hi / y.hi;
  const double remainder = std::fma(-q, y.hi, x.hi) + std::fma(-q, y.lo, x.lo);
  const double inherited = (x.error + std::abs(q) * y.error + kUnderflow) * std::abs(inverse);
  return bounded(fast_two_sum(q, remainder * inverse), inherited + 0x1p-102 * std::abs(q) + kUnderflow);
}

// Declined unless x >= 2^-900 and x.error is negligible beside x. Let s be the root of x.hi, rounded, and x = s^2 (1 +
// d), |d| <= 3.1 u. The remainder x.hi - s^2 is a double; adding x.lo to it errs by 3.1 u^2 s^2, of which the factor
// 1 / 2 s leaves half; that factor and the product with it err by 1.6 u^2 s each; the term -d^2 / 8 left out is below
// 1.3 u^2. In all below 6.1 u^2 s; 8 u^2 s is taken.
EXACTFF_INLINE Bounded square_root(const Bounded& x) {
  if (!(x.hi >= 0x1p-900 && x.error <= kNegligible * x.hi)) return kDeclined;
  const double s = std::sqrt(x.hi);
  const double half_inverse = 0.5 / s;
  const double remainder = std::fma(-s, s, x.hi) + x.lo;
  return bounded(fast_two_sum(s, remainder * half_inverse), x.error * half_inverse + 0x1p-103 * s);
}

}  // namespace exactff::kernel::double_double
