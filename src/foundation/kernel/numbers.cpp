#include "kernel/numbers.h"

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

// --- Exact vec ---

namespace {

// a b - c d
void set_det(Integer& result, const Integer& a, const Integer& b, const Integer& c, const Integer& d) {
  result = a * b;
  mpz_submul(result.get_mpz_t(), c.get_mpz_t(), d.get_mpz_t());
}

}  // namespace

void set_dot(Integer& result, const ExactVec3& a, const ExactVec3& b) {
  result = a.x * b.x;
  mpz_addmul(result.get_mpz_t(), a.y.get_mpz_t(), b.y.get_mpz_t());
  mpz_addmul(result.get_mpz_t(), a.z.get_mpz_t(), b.z.get_mpz_t());
}

void set_cross(ExactVec3& result, const ExactVec3& a, const ExactVec3& b) {
  set_det(result.x, a.y, b.z, a.z, b.y);
  set_det(result.y, a.z, b.x, a.x, b.z);
  set_det(result.z, a.x, b.y, a.y, b.x);
}

Integer dot(const ExactVec3& a, const ExactVec3& b) {
  Integer result;
  set_dot(result, a, b);
  return result;
}

ExactVec3 cross(const ExactVec3& a, const ExactVec3& b) {
  ExactVec3 result;
  set_cross(result, a, b);
  return result;
}

ExactVec3 operator-(const ExactVec3& a, const ExactVec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
ExactVec3 operator+(const ExactVec3& a, const ExactVec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
ExactVec3 operator*(const ExactVec3& a, const Integer& s) { return {a.x * s, a.y * s, a.z * s}; }

bool is_zero(const ExactVec3& a) { return sign(a.x) == 0 && sign(a.y) == 0 && sign(a.z) == 0; }

long bit_length(const ExactVec3& a) { return std::max({bit_length(a.x), bit_length(a.y), bit_length(a.z)}); }

int longest_axis(const ExactVec3& a) {
  int longest = 0;
  for (const int axis : {1, 2}) {
    if (mpz_cmpabs(a[axis].get_mpz_t(), a[longest].get_mpz_t()) > 0) longest = axis;
  }
  return longest;
}

void negate(ExactVec3& a) {
  for (Integer* c : {&a.x, &a.y, &a.z}) mpz_neg(c->get_mpz_t(), c->get_mpz_t());
}

void make_primitive(ExactVec3& a) {
  const Integer divisor = gcd(gcd(a.x, a.y), a.z);
  if (divisor <= 1) return;
  for (Integer* c : {&a.x, &a.y, &a.z}) mpz_divexact(c->get_mpz_t(), c->get_mpz_t(), divisor.get_mpz_t());
}

namespace {

// (a - b) 2^-exponent. Requires that neither a nor b has a smaller exponent.
void set_scaled_difference(Integer& result, const BinaryDouble& a, const BinaryDouble& b, long exponent) {
  constexpr int kSpareBits = 9;  // bits of a long that remain beside a mantissa, a carry and the sign
  const bool a_is_finer = a.exponent < b.exponent;
  const BinaryDouble &fine = a_is_finer ? a : b, &coarse = a_is_finer ? b : a;
  const int shift = coarse.exponent - fine.exponent;
  if (shift <= kSpareBits) {
    result = (coarse.mantissa << shift) - fine.mantissa;
  } else {
    result = coarse.mantissa;
    result <<= static_cast<mp_bitcnt_t>(shift);
    result -= fine.mantissa;
  }
  result <<= static_cast<mp_bitcnt_t>(fine.exponent - exponent);
  if (a_is_finer) mpz_neg(result.get_mpz_t(), result.get_mpz_t());
}

}  // namespace

void set_difference(ScaledVec3& result, const Vec3& p, const Vec3& q) {
  const BinaryDouble numbers[] = {decompose(p.x), decompose(p.y), decompose(p.z),
                                  decompose(q.x), decompose(q.y), decompose(q.z)};
  int exponent = BinaryDouble::kExponentOfZero;
  for (const BinaryDouble& number : numbers) exponent = std::min(exponent, number.exponent);
  set_scaled_difference(result.v.x, numbers[0], numbers[3], exponent);
  set_scaled_difference(result.v.y, numbers[1], numbers[4], exponent);
  set_scaled_difference(result.v.z, numbers[2], numbers[5], exponent);
  result.exponent = exponent;
}

ScaledVec3 exact_difference(const Vec3& p, const Vec3& q) {
  ScaledVec3 result;
  set_difference(result, p, q);
  return result;
}

ScaledVec3 exact_vector(const Vec3& p) { return exact_difference(p, Vec3{}); }

void lower_exponent(ScaledVec3& a, long exponent) {
  const auto shift = static_cast<mp_bitcnt_t>(a.exponent - exponent);
  for (Integer* c : {&a.v.x, &a.v.y, &a.v.z}) *c <<= shift;
  a.exponent = exponent;
}

namespace {

// Kept for its memory. Exponents are ignored, since a positive scale does not change a sign.
struct Scratch {
  ScaledVec3 n, a, b, c;
  ExactVec3 cross;
  Integer result;
};

Scratch& scratch() {
  thread_local Scratch own;
  return own;
}

}  // namespace

int exact_sign_of_dot(const Vec3& n, const Arrow& a) {
  Scratch& s = scratch();
  set_difference(s.n, n, Vec3{});
  set_difference(s.a, a.to, a.from);
  set_dot(s.result, s.n.v, s.a.v);
  return sign(s.result);
}

int exact_sign_of_det(const Arrow& a, const Arrow& b, const Arrow& c) {
  Scratch& s = scratch();
  set_difference(s.a, a.to, a.from);
  set_difference(s.b, b.to, b.from);
  set_difference(s.c, c.to, c.from);
  set_cross(s.cross, s.b.v, s.c.v);
  set_dot(s.result, s.a.v, s.cross);
  return sign(s.result);
}

}  // namespace exactff::kernel
