// Exact numbers, and vectors of them. Every double is converted without rounding; only nearest_double rounds back.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "exactff/geometry.h"
#include "kernel/expect.h"

namespace exactff::kernel {

#ifdef __FAST_MATH__
#error "exactff needs IEEE arithmetic: do not compile with -ffast-math"
#endif

using Integer = mpz_class;
using Rational = mpq_class;

// -1, 0 or +1.
inline int sign(const Integer& a) { return sgn(a); }
inline int sign(const Rational& a) { return sgn(a); }

// The same of a - b.
inline int compare(const Integer& a, const Integer& b) {
  const int order = cmp(a, b);
  return order < 0 ? -1 : order > 0 ? 1 : 0;
}

// In lowest terms.
inline Rational ratio(const Integer& numerator, const Integer& denominator) {
  Rational result(numerator, denominator);
  result.canonicalize();
  return result;
}

// Bits of |a|; 0 for 0.
inline long bit_length(const Integer& a) {
  return sign(a) == 0 ? 0 : static_cast<long>(mpz_sizeinbase(a.get_mpz_t(), 2));
}

// value * 2^exponent.
Rational times_power_of_two(Rational value, long exponent);

// Requires a finite value; exact, denormals included.
inline Rational to_rational(double value) {
  EXACTFF_EXPECT(std::isfinite(value));
  return Rational(value);
}

// Correctly rounded, ties to even, gradual underflow; overflow gives an infinity.
double nearest_double(const Rational& value);
// The same for numerator / denominator * 2^exponent. Requires a positive denominator.
double nearest_double(const Integer& numerator, const Integer& denominator, long exponent);
// The same for a * 2^exponent.
double nearest_double(const Integer& a, long exponent);

// "p/q" in lowest terms, or "p".
std::string to_string(const Rational& value);

// A finite double as mantissa * 2^exponent, with an odd mantissa of magnitude below 2^53; or zero, with an exponent
// larger than that of any other double.
struct BinaryDouble {
  static constexpr int kExponentOfZero = 1024;
  long mantissa = 0;
  int exponent = kExponentOfZero;
};
inline BinaryDouble decompose(double value) {
  constexpr int kStoredBits = 52, kBias = 1075;
  EXACTFF_EXPECT(std::isfinite(value));
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t stored = bits & ((std::uint64_t{1} << kStoredBits) - 1);
  const int exponent = static_cast<int>(bits >> kStoredBits & 0x7FFU);
  const std::uint64_t magnitude = exponent == 0 ? stored : stored | std::uint64_t{1} << kStoredBits;
  if (magnitude == 0) return {};
  const int zeros = std::countr_zero(magnitude);
  const auto odd = static_cast<long>(magnitude >> zeros);
  return {std::signbit(value) ? -odd : odd, std::max(exponent, 1) - kBias + zeros};
}

// --- Exact vec ---

// Exact vectors with a common binary exponent: the vector is (x, y, z) * 2^exponent.
//
// Directions and signs on the exact path need only the integers. The exponent keeps the integers short if all
// coordinates have a similar magnitude, however large or small it is.

struct ExactVec3 {
  Integer x;
  Integer y;
  Integer z;

  const Integer& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

struct ScaledVec3 {
  ExactVec3 v;
  long exponent = 0;
};

Integer dot(const ExactVec3& a, const ExactVec3& b);
ExactVec3 cross(const ExactVec3& a, const ExactVec3& b);
ExactVec3 operator-(const ExactVec3& a, const ExactVec3& b);
ExactVec3 operator+(const ExactVec3& a, const ExactVec3& b);
ExactVec3 operator*(const ExactVec3& a, const Integer& s);
bool is_zero(const ExactVec3& a);
long bit_length(const ExactVec3& a);   // of the largest component
int longest_axis(const ExactVec3& a);  // axis of the largest component, the first of equal ones
void negate(ExactVec3& a);

// Divides by the greatest common divisor of the components. The direction does not change.
void make_primitive(ExactVec3& a);

// p - q, exactly.
ScaledVec3 exact_difference(const Vec3& p, const Vec3& q);
ScaledVec3 exact_vector(const Vec3& p);

// Rewrites the vector with a smaller exponent; its value does not change.
void lower_exponent(ScaledVec3& a, long exponent);

// --- Results in existing memory. `result` must not be an operand. Nothing is allocated once it is large enough. ---

void set_dot(Integer& result, const ExactVec3& a, const ExactVec3& b);
void set_cross(ExactVec3& result, const ExactVec3& a, const ExactVec3& b);
void set_difference(ScaledVec3& result, const Vec3& p, const Vec3& q);  // p - q

// --- Exact signs. Nothing is allocated after the first few calls. ---

struct Arrow {
  const Vec3& from;
  const Vec3& to;
};
// Sign of n . (to - from).
int exact_sign_of_dot(const Vec3& n, const Arrow& a);
// Sign of the determinant of three arrows.
int exact_sign_of_det(const Arrow& a, const Arrow& b, const Arrow& c);
// Sign of det(b - a, c - a, d - a).
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return exact_sign_of_det({a, b}, {a, c}, {a, d});
}

// --- Rational vec ---

// Vectors of rational numbers.

struct RationalVec3 {
  Rational x;
  Rational y;
  Rational z;

  const Rational& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

inline RationalVec3 to_rational(const Vec3& a) { return {to_rational(a.x), to_rational(a.y), to_rational(a.z)}; }
inline RationalVec3 to_rational(const ExactVec3& a) { return {Rational(a.x), Rational(a.y), Rational(a.z)}; }

inline RationalVec3 operator-(const RationalVec3& a, const RationalVec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline RationalVec3 operator+(const RationalVec3& a, const RationalVec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline RationalVec3 operator*(const RationalVec3& a, const Rational& s) { return {a.x * s, a.y * s, a.z * s}; }
inline Rational dot(const RationalVec3& a, const RationalVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline RationalVec3 cross(const RationalVec3& a, const RationalVec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3 nearest_double(const RationalVec3& a) {
  return {nearest_double(a.x), nearest_double(a.y), nearest_double(a.z)};
}
inline bool is_zero(const RationalVec3& a) { return sign(a.x) == 0 && sign(a.y) == 0 && sign(a.z) == 0; }

// A positive multiple in integers without a common divisor.
inline ExactVec3 direction_of(const RationalVec3& a) {
  const Integer all = lcm(lcm(a.x.get_den(), a.y.get_den()), a.z.get_den());
  const auto component = [&](const Rational& c) { return Integer(c.get_num() * (all / c.get_den())); };
  ExactVec3 result{component(a.x), component(a.y), component(a.z)};
  make_primitive(result);
  return result;
}

}  // namespace exactff::kernel
