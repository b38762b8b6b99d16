#include "kernel/numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace exactff::kernel {

namespace {

constexpr long kMantissaBits = std::numeric_limits<double>::digits;
constexpr long kLowestExponent = std::numeric_limits<double>::min_exponent - kMantissaBits;  // of a denormal's last bit

constexpr long kWholeBits = 64;
static_assert(sizeof(unsigned long) == sizeof(std::uint64_t));  // mpz_get_ui returns all bits

// (whole + f) * 2^exponent, where 0 <= f < 1, and f > 0 if `more`: then `whole` has more than 54 bits.
double rounded(std::uint64_t whole, bool more, long exponent) {
  const long excess = std::max<long>(std::bit_width(whole) - kMantissaBits, kLowestExponent - exponent);
  if (excess <= 0) return std::ldexp(static_cast<double>(whole), static_cast<int>(exponent));  // exact
  std::uint64_t kept = excess < kWholeBits ? whole >> excess : 0;
  if (excess <= kWholeBits) {
    const std::uint64_t half = std::uint64_t{1} << (excess - 1), cut = whole & (half | (half - 1));
    if (cut > half || (cut == half && (more || kept % 2 != 0))) ++kept;  // ties to even
  }
  return std::ldexp(static_cast<double>(kept), static_cast<int>(exponent + excess));
}

}  // namespace

double nearest_double(const Integer& a, long exponent) {
  const long cut = std::max(bit_length(a) - kWholeBits, 0L);
  Integer high;
  if (cut > 0) mpz_tdiv_q_2exp(high.get_mpz_t(), a.get_mpz_t(), static_cast<mp_bitcnt_t>(cut));
  const bool more = cut > 0 && mpz_scan1(a.get_mpz_t(), 0) < static_cast<mp_bitcnt_t>(cut);
  const double magnitude = rounded(mpz_get_ui((cut > 0 ? high : a).get_mpz_t()), more, exponent + cut);
  return sign(a) < 0 ? -magnitude : magnitude;
}

// The quotient is cut to a whole number of 63 or 64 bits.
double nearest_double(const Integer& numerator, const Integer& denominator, long exponent) {
  EXACTFF_EXPECT(sign(denominator) > 0);
  if (sign(numerator) == 0) return 0.0;
  const long scale = kWholeBits - 1 - (bit_length(numerator) - bit_length(denominator));
  Integer scaled, quotient, rest;
  scaled = (scale > 0 ? numerator : denominator) << static_cast<mp_bitcnt_t>(std::abs(scale));
  mpz_tdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), (scale > 0 ? scaled : numerator).get_mpz_t(),
              (scale > 0 ? denominator : scaled).get_mpz_t());
  const double magnitude = rounded(mpz_get_ui(quotient.get_mpz_t()), sign(rest) != 0, exponent - scale);
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
