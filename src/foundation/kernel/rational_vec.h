// Vectors of rational numbers.
#pragma once

#include "exactff/geometry.h"
#include "kernel/exact_vec.h"
#include "kernel/numbers.h"

namespace exactff::kernel {

struct RationalVec3 {
  Rational x;
  Rational y;
  Rational z;
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
