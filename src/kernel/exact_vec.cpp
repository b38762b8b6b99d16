#include "kernel/exact_vec.h"

#include <CGAL/Mpzf.h>

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

namespace {

using CGAL::Mpzf;

struct Terms {
  explicit Terms(const Arrow& a)
      : x(Mpzf(a.to.x) - Mpzf(a.from.x)), y(Mpzf(a.to.y) - Mpzf(a.from.y)), z(Mpzf(a.to.z) - Mpzf(a.from.z)) {}
  Mpzf x, y, z;
};

}  // namespace

int exact_sign_of_dot(const Vec3& n, const Arrow& a) {
  const Terms t(a);
  return (Mpzf(n.x) * t.x + Mpzf(n.y) * t.y + Mpzf(n.z) * t.z).sign();
}

int exact_sign_of_det(const Arrow& a, const Arrow& b, const Arrow& c) {
  const Terms p(a), q(b), r(c);
  return (p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) + p.z * (q.x * r.y - q.y * r.x)).sign();
}

}  // namespace exactff::kernel
