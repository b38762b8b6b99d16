// Exact vectors with a common binary exponent: the vector is (x, y, z) * 2^exponent.
//
// Directions and signs on the exact path need only the integers. The exponent keeps the integers short if all
// coordinates have a similar magnitude, however large or small it is.
#pragma once

#include "exactff/geometry.h"
#include "kernel/numbers.h"

namespace exactff::kernel {

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

}  // namespace exactff::kernel
