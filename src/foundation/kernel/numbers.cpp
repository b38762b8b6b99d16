#include "kernel/numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace exactff::kernel {

namespace {

constexpr long kMantissaBits = std::numeric_limits<double>::digits;
constexpr long kLowestExponent = std::numeric_limits<double>::min_exponent - kMantissaBits;  // of a denormal's last bit

// floor(positive * 2^-exponent). Sets `compare_rest_with_half` to the sign of (the fraction cut off - 1/2).
Integer scaled_quotient(const Rational& positive, long exponent, int& compare_rest_with_half) {
  Integer numerator = positive.get_num();
  Integer denominator = positive.get_den();
  if (exponent >= 0) {
    denominator <<= static_cast<mp_bitcnt_t>(exponent);
  } else {
    numerator <<= static_cast<mp_bitcnt_t>(-exponent);
  }
  Integer quotient;
  Integer rest;
  mpz_fdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  rest <<= 1;
  compare_rest_with_half = cmp(rest, denominator);
  return quotient;
}

// |a| * 2^-shift, to nearest, ties to even.
Integer rounded_shift(const Integer& a, long shift) {
  const auto bits = static_cast<mp_bitcnt_t>(shift);
  Integer quotient = abs(a);
  const bool half = mpz_tstbit(quotient.get_mpz_t(), bits - 1) != 0;
  const bool more = mpz_scan1(quotient.get_mpz_t(), 0) < bits - 1;
  quotient >>= bits;
  if (half && (more || mpz_odd_p(quotient.get_mpz_t()))) ++quotient;
  return quotient;
}

}  // namespace

double nearest_double(const Integer& a, long exponent) {
  const long excess = std::max(bit_length(a) - kMantissaBits, kLowestExponent - exponent);
  if (excess <= 0) return std::ldexp(a.get_d(), static_cast<int>(exponent));  // exact
  const double magnitude = std::ldexp(rounded_shift(a, excess).get_d(), static_cast<int>(exponent + excess));
  return sign(a) < 0 ? -magnitude : magnitude;
}

double nearest_double(const Rational& value) {
  if (sign(value) == 0) return 0.0;
  const Rational magnitude = abs(value);
  // Choose the exponent of the last bit so that the quotient has 53 or 54 bits, or is a denormal.
  long exponent = bit_length(magnitude.get_num()) - bit_length(magnitude.get_den()) - kMantissaBits;
  if (exponent < kLowestExponent) exponent = kLowestExponent;
  int rest = 0;
  Integer mantissa = scaled_quotient(magnitude, exponent, rest);
  if (bit_length(mantissa) > kMantissaBits) {
    ++exponent;
    mantissa = scaled_quotient(magnitude, exponent, rest);
  }
  if (rest > 0 || (rest == 0 && mpz_odd_p(mantissa.get_mpz_t()))) ++mantissa;
  const double rounded = std::ldexp(mantissa.get_d(), static_cast<int>(exponent));  // exact, or overflows
  return sign(value) < 0 ? -rounded : rounded;
}

Rational times_power_of_two(Rational value, long exponent) {
  const auto bits = static_cast<mp_bitcnt_t>(std::abs(exponent));
  (exponent >= 0 ? mpq_mul_2exp : mpq_div_2exp)(value.get_mpq_t(), value.get_mpq_t(), bits);
  return value;
}

std::string to_string(const Rational& value) { return value.get_str(); }

}  // namespace exactff::kernel
