#include "kernel/exact_vec.h"

#include <algorithm>
#include <array>
#include <limits>

namespace exactff::kernel {

Integer dot(const ExactVec3& a, const ExactVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ExactVec3 cross(const ExactVec3& a, const ExactVec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
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

Integer shifted(const BinaryDouble& number, long exponent) {
  Integer result(number.mantissa);
  if (number.mantissa != 0.0) result <<= static_cast<mp_bitcnt_t>(number.exponent - exponent);
  return result;
}

}  // namespace

ScaledVec3 exact_difference(const Vec3& p, const Vec3& q) {
  const std::array<BinaryDouble, 6> numbers = {decompose(p.x), decompose(p.y), decompose(p.z),
                                               decompose(q.x), decompose(q.y), decompose(q.z)};
  long exponent = std::numeric_limits<long>::max();
  for (const BinaryDouble& number : numbers) {
    if (number.mantissa != 0.0) exponent = std::min<long>(exponent, number.exponent);
  }
  if (exponent == std::numeric_limits<long>::max()) return {};
  const auto difference = [&](int axis) -> Integer {
    return shifted(numbers[axis], exponent) - shifted(numbers[axis + 3], exponent);
  };
  return {{difference(0), difference(1), difference(2)}, exponent};
}

ScaledVec3 exact_vector(const Vec3& p) { return exact_difference(p, Vec3{}); }

void lower_exponent(ScaledVec3& a, long exponent) {
  const auto shift = static_cast<mp_bitcnt_t>(a.exponent - exponent);
  for (Integer* c : {&a.v.x, &a.v.y, &a.v.z}) *c <<= shift;
  a.exponent = exponent;
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // Each row may keep its own exponent: a positive factor does not change the sign.
  const ExactVec3 ab = exact_difference(b, a).v;
  const ExactVec3 ac = exact_difference(c, a).v;
  const ExactVec3 ad = exact_difference(d, a).v;
  return sign(dot(cross(ab, ac), ad));
}

}  // namespace exactff::kernel
