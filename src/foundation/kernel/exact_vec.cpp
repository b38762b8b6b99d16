#include "kernel/exact_vec.h"

#include <algorithm>

namespace exactff::kernel {

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
