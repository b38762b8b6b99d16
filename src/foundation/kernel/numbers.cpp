#include "kernel/numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace exactff::kernel {

namespace {

constexpr long kMantissaBits = std::numeric_limits<double>::digits;
constexpr long kLowestExponent = std::numeric_limits<double>::min_exponent - kMantissaBits;  // of a denormal's last bit

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

// The quotient is cut to a whole number of 63 or 64 bits, at least ten more than a double has. So whether anything was
// cut off matters only if the rest of the bits are those of one half.
double nearest_double(const Integer& numerator, const Integer& denominator, long exponent) {
  static_assert(sizeof(unsigned long) == sizeof(std::uint64_t));
  constexpr long kWholeBits = 64;
  EXACTFF_EXPECT(sign(denominator) > 0);
  if (sign(numerator) == 0) return 0.0;
  const long scale = kWholeBits - 1 - (bit_length(numerator) - bit_length(denominator));
  Integer scaled, quotient, rest;
  const auto divide = [&](const Integer& n, const Integer& d) {
    mpz_tdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), n.get_mpz_t(), d.get_mpz_t());
  };
  if (scale >= 0) {
    mpz_mul_2exp(scaled.get_mpz_t(), numerator.get_mpz_t(), static_cast<mp_bitcnt_t>(scale));
    divide(scaled, denominator);
  } else {
    mpz_mul_2exp(scaled.get_mpz_t(), denominator.get_mpz_t(), static_cast<mp_bitcnt_t>(-scale));
    divide(numerator, scaled);
  }
  const std::uint64_t whole = mpz_get_ui(quotient.get_mpz_t());  // of its magnitude
  const long last = exponent - scale;                            // the power of two of its last bit
  const long excess = std::max<long>(std::bit_width(whole) - kMantissaBits, kLowestExponent - last);
  std::uint64_t kept = excess < kWholeBits ? whole >> excess : 0;
  if (excess <= kWholeBits) {
    const std::uint64_t half = std::uint64_t{1} << (excess - 1), cut = whole & (half | (half - 1));
    if (cut > half || (cut == half && (sign(rest) != 0 || kept % 2 != 0))) ++kept;
  }
  const double magnitude = std::ldexp(static_cast<double>(kept), static_cast<int>(last + excess));  // or it overflows
  return sign(numerator) < 0 ? -magnitude : magnitude;
}

double nearest_double(const Rational& value) { return nearest_double(value.get_num(), value.get_den(), 0); }

Rational times_power_of_two(Rational value, long exponent) {
  const auto bits = static_cast<mp_bitcnt_t>(std::abs(exponent));
  (exponent >= 0 ? mpq_mul_2exp : mpq_div_2exp)(value.get_mpq_t(), value.get_mpq_t(), bits);
  return value;
}

std::string to_string(const Rational& value) { return value.get_str(); }

}  // namespace exactff::kernel
