#include "kernel/numbers.h"

#include <cmath>
#include <cstdlib>
#include <limits>

namespace exactff::kernel {

namespace {

constexpr long kMantissaBits = std::numeric_limits<double>::digits;
constexpr long kLowestExponent = std::numeric_limits<double>::min_exponent - kMantissaBits;  // of a denormal's last bit

// floor(numerator * 2^-exponent / denominator) and whether anything was cut off.
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

}  // namespace

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

BinaryDouble decompose(double value) {
  if (value == 0.0) return {};
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return {std::ldexp(fraction, kMantissaBits), exponent - static_cast<int>(kMantissaBits)};
}

}  // namespace exactff::kernel
