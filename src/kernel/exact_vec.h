// Exact vectors with a common binary exponent: the vector is (x, y, z) * 2^exponent.
//
// Everything on the exact path that is a direction or a sign needs only the integers; the exponent keeps
// integers short where coordinates are of one magnitude, whatever that magnitude is.
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
int longest_axis(const ExactVec3& a);  // that of the largest component, the first of equals
void negate(ExactVec3& a);

// Divides by the greatest common divisor; the direction stays.
void make_primitive(ExactVec3& a);

// p - q, exactly.
ScaledVec3 exact_difference(const Vec3& p, const Vec3& q);
ScaledVec3 exact_vector(const Vec3& p);

// The same vector with a smaller exponent.
void lower_exponent(ScaledVec3& a, long exponent);

// --- In the memory of a result, which is none of the operands: once it has held as much, nothing is allocated ---

void set_dot(Integer& result, const ExactVec3& a, const ExactVec3& b);
void set_cross(ExactVec3& result, const ExactVec3& a, const ExactVec3& b);
void set_difference(ScaledVec3& result, const Vec3& p, const Vec3& q);  // p - q

// --- Signs, exactly; after the first few nothing is allocated here either ---

struct Arrow {
  const Vec3& from;
  const Vec3& to;
};
// Of n . (to - from).
int exact_sign_of_dot(const Vec3& n, const Arrow& a);
// Of the determinant of three arrows.
int exact_sign_of_det(const Arrow& a, const Arrow& b, const Arrow& c);
// Of det(b - a, c - a, d - a).
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return exact_sign_of_det({a, b}, {a, c}, {a, d});
}

}  // namespace exactff::kernel
