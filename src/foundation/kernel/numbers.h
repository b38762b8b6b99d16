// Exact numbers. Every double is converted without rounding; only nearest_double rounds back.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "kernel/expect.h"

namespace exactff::kernel {

#ifdef __FAST_MATH__
#error "exactff needs IEEE arithmetic: do not compile with -ffast-math"
#endif

using Integer = mpz_class;
using Rational = mpq_class;

// -1, 0 or +1.
inline int sign(const Integer& a) { return sgn(a); }
inline int sign(const Rational& a) { return sgn(a); }

// Bits of |a|; 0 for 0.
inline long bit_length(const Integer& a) {
  return sign(a) == 0 ? 0 : static_cast<long>(mpz_sizeinbase(a.get_mpz_t(), 2));
}

// value * 2^exponent.
Rational times_power_of_two(Rational value, long exponent);

// Requires a finite value; exact, denormals included.
inline Rational to_rational(double value) {
  EXACTFF_EXPECT(std::isfinite(value));
  return Rational(value);
}

// Correctly rounded, ties to even, gradual underflow; overflow gives an infinity.
double nearest_double(const Rational& value);
// The same for numerator / denominator * 2^exponent. Requires a positive denominator.
double nearest_double(const Integer& numerator, const Integer& denominator, long exponent);
// The same for a * 2^exponent.
double nearest_double(const Integer& a, long exponent);

// "p/q" in lowest terms, or "p".
std::string to_string(const Rational& value);

// A finite double as mantissa * 2^exponent, with an odd mantissa of magnitude below 2^53; or zero, with an exponent
// larger than that of any other double.
struct BinaryDouble {
  static constexpr int kExponentOfZero = 1024;
  long mantissa = 0;
  int exponent = kExponentOfZero;
};
inline BinaryDouble decompose(double value) {
  constexpr int kStoredBits = 52, kBias = 1075;
  EXACTFF_EXPECT(std::isfinite(value));
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t stored = bits & ((std::uint64_t{1} << kStoredBits) - 1);
  const int exponent = static_cast<int>(bits >> kStoredBits & 0x7FFU);
  const std::uint64_t magnitude = exponent == 0 ? stored : stored | std::uint64_t{1} << kStoredBits;
  if (magnitude == 0) return {};
  const int zeros = std::countr_zero(magnitude);
  const auto odd = static_cast<long>(magnitude >> zeros);
  return {std::signbit(value) ? -odd : odd, std::max(exponent, 1) - kBias + zeros};
}

}  // namespace exactff::kernel
