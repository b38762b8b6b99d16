#include "kernel/plane_crossing.h"

#include <algorithm>
#include <cmath>

#include "kernel/vec.h"

namespace exactff::kernel {

using namespace double_double;

namespace {

using BoundedTriple = std::array<Bounded, 3>;

std::array<double, 3> components(const Vec3& v) { return {v.x, v.y, v.z}; }

// (p - q) * scale, exact except for underflow.
EXACTFF_INLINE BoundedTriple difference(const Vec3& p, const Vec3& q, double scale) {
  const std::array<double, 3> from = components(q), to = components(p);
  BoundedTriple d;
  for (int i = 0; i < 3; ++i) {
    const DoubleDouble exact = two_sum(to[i], -from[i]);
    d[i] = {exact.hi * scale, exact.lo * scale, kUnderflow};
  }
  return d;
}

EXACTFF_INLINE Bounded magnitude(const Bounded& x) { return x.hi < 0.0 ? -x : x; }

EXACTFF_INLINE Bounded dot(const BoundedTriple& a, const BoundedTriple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool is_zero(const Bounded& c) { return c.hi == 0.0 && c.lo == 0.0 && c.error == 0.0; }

// The axis normal to the plane, if there is one and the plane contains x: the component of crossings along it is
// exactly 0.
int zero_axis(const Vec3& x, const Vec3& s, const BoundedTriple& normal) {
  const std::array<double, 3> xc = components(x), sc = components(s);
  for (int i = 0; i < 3; ++i) {
    if (xc[i] == sc[i] && is_zero(normal[(i + 1) % 3]) && is_zero(normal[(i + 2) % 3])) return i;
  }
  return -1;
}

// False where the sign of a height is not certain: the crossing is then unknown. Its component along `axis` is 0.
EXACTFF_CLONES
bool cross(const Vec3& p, const Vec3& q, const Vec3& x, const Vec3& s, const BoundedTriple& normal, int axis,
           double scale, BoundedTriple& result) {
  const Bounded g_p = dot(normal, difference(p, s, scale)), g_q = dot(normal, difference(q, s, scale));
  if (!sign_is_certain(g_p) || !sign_is_certain(g_q)) return false;
  const BoundedTriple t_p = difference(p, x, scale), t_q = difference(q, x, scale);
  const Bounded l = magnitude(g_q), m = magnitude(g_p);
  const std::array<double, 3> pc = components(p), qc = components(q), xc = components(x);
  for (int i = 0; i < 3; ++i) {
    const bool zero = i == axis || (pc[i] == xc[i] && qc[i] == xc[i]);
    result[i] = zero ? Bounded{} : sum_of_products(t_p[i], l, t_q[i], m);
  }
  return true;
}

// With u = 2^-53, |c - hi| <= |lo| + error <= 1.5 u |hi|, less than 2u |c|. It stays normal when the largest component,
// which is at most 2^300, is scaled to 1. False for NaN.
bool is_fine(const Bounded& c) {
  return is_zero(c) || (std::abs(c.hi) >= 0x1p-600 && kInflation * c.error <= 0x1p-54 * std::abs(c.hi));
}

// The two leading doubles of a number divided by 2^bits. Each is truncated to 53 bits: the rest after the first is
// below 2^-52 of the number, and the rest after the second is below 2^-104.
Bounded leading(const Integer& number, long bits) {
  if (sign(number) == 0) return {};
  long exponent = 0;
  const double first = mpz_get_d_2exp(&exponent, number.get_mpz_t());
  thread_local Integer rest, head;  // kept, so that nothing is allocated
  rest = number;
  head = std::ldexp(first, 53);
  if (exponent >= 53) {
    head <<= static_cast<unsigned long>(exponent - 53);
  } else {
    head >>= static_cast<unsigned long>(53 - exponent);  // no fraction: the number has at most `exponent` bits
  }
  rest -= head;
  long rest_exponent = 0;
  const double second = mpz_get_d_2exp(&rest_exponent, rest.get_mpz_t());  // truncated
  const auto scaled = [&](double mantissa, long e) {
    return std::ldexp(mantissa, static_cast<int>(std::max(e - bits, -4000L)));
  };
  const double hi = scaled(first, exponent), lo = second == 0.0 ? 0.0 : scaled(second, rest_exponent);
  return bounded(fast_two_sum(hi, lo), 0x1p-104 * std::abs(hi) + kUnderflow);
}

}  // namespace

FineNormal fine_normal(const ExactVec3& normal) {
  const long bits = bit_length(normal);
  return {leading(normal.x, bits), leading(normal.y, bits), leading(normal.z, bits)};
}

FineNormal fine_normal(const Vec3& normal) {
  int exponent = 0;
  static_cast<void>(std::frexp(max_norm(normal), &exponent));
  const auto scaled = [&](double c) {
    return c == 0.0 ? Bounded{} : Bounded{std::ldexp(c, -exponent), 0.0, kUnderflow};
  };
  return {scaled(normal.x), scaled(normal.y), scaled(normal.z)};
}

void PlaneCrossings::start(const Vec3& x, const FineNormal& normal, const Vec3& point, int scale_exponent) {
  x_ = x;
  normal_ = normal;
  point_ = point;
  zero_axis_ = zero_axis(x, point, normal);
  scale_exponent_ = scale_exponent;
  scale_ = std::ldexp(1.0, scale_exponent);
}

std::optional<PlaneCrossings::Fine> PlaneCrossings::fine(const Vec3& p, const Vec3& q) const {
  BoundedTriple c;
  if (!cross(p, q, x_, point_, normal_, zero_axis_, scale_, c)) return std::nullopt;
  const double largest = std::max({std::abs(c[0].hi), std::abs(c[1].hi), std::abs(c[2].hi)});
  if (!is_moderate(largest) || !is_fine(c[0]) || !is_fine(c[1]) || !is_fine(c[2])) return std::nullopt;
  Fine result;
  static_cast<void>(std::frexp(largest, &result.exponent));
  result.exponent = -result.exponent;
  const double normalisation = std::ldexp(1.0, result.exponent);
  for (int i = 0; i < 3; ++i) {
    result.direction.hi[i] = c[i].hi * normalisation;
    result.direction.lo[i] = c[i].lo * normalisation;
    result.direction.error = std::max(result.direction.error, kInflation * c[i].error * normalisation);
  }
  result.direction.error += kUnderflow;
  return result;
}

namespace {

void set_magnitude_of_dot(Integer& result, const ExactVec3& a, const ExactVec3& b) {
  set_dot(result, a, b);
  mpz_abs(result.get_mpz_t(), result.get_mpz_t());
}

// a b + c d
void set_sum_of_products(Integer& result, const Integer& a, const Integer& b, const Integer& c, const Integer& d) {
  result = a * b;
  mpz_addmul(result.get_mpz_t(), c.get_mpz_t(), d.get_mpz_t());
}

}  // namespace

void PlaneCrossings::set_exact(ScaledVec3& result, const Vec3& p, const Vec3& q, const ExactVec3& normal,
                               long fine_exponent) {
  set_difference(t_p_, p, x_);
  set_difference(t_q_, q, x_);
  set_difference(d_p_, p, point_);
  set_difference(d_q_, q, point_);
  const long t_exponent = std::min(t_p_.exponent, t_q_.exponent), d_exponent = std::min(d_p_.exponent, d_q_.exponent);
  lower_exponent(t_p_, t_exponent);
  lower_exponent(t_q_, t_exponent);
  lower_exponent(d_p_, d_exponent);
  lower_exponent(d_q_, d_exponent);
  set_magnitude_of_dot(g_p_, normal, d_p_.v);
  set_magnitude_of_dot(g_q_, normal, d_q_.v);
  set_sum_of_products(result.v.x, t_p_.v.x, g_q_, t_q_.v.x, g_p_);
  set_sum_of_products(result.v.y, t_p_.v.y, g_q_, t_q_.v.y, g_p_);
  set_sum_of_products(result.v.z, t_p_.v.z, g_q_, t_q_.v.z, g_p_);
  result.exponent = t_exponent + d_exponent + 2L * scale_exponent_ - bit_length(normal) + fine_exponent;
}

}  // namespace exactff::kernel
