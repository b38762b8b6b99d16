// Exact numbers. Every double is converted without rounding; the only rounding back is nearest_double.
#pragma once

#include <gmpxx.h>

#include <string>

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
inline Rational to_rational(double value) { return Rational(value); }

// Correctly rounded, ties to even, gradual underflow; overflow gives an infinity.
double nearest_double(const Rational& value);
// The same of a * 2^exponent; it must not overflow.
double nearest_double(const Integer& a, long exponent);

// "p/q" in lowest terms, or "p".
std::string to_string(const Rational& value);

// A finite double as mantissa * 2^exponent with a whole mantissa of magnitude below 2^53; zero has exponent 0.
struct BinaryDouble {
  double mantissa = 0.0;
  int exponent = 0;
};
BinaryDouble decompose(double value);

}  // namespace exactff::kernel
