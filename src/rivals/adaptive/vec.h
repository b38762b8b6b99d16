// Plain double vectors for the sampled methods.
#pragma once

#include <cmath>

#include "exactff/geometry.h"
#include "kernel/expect.h"
#include "kernel/vec.h"

namespace exactff::adaptive {

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(const Vec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }

using kernel::cross;
using kernel::dot;
using kernel::max_norm;

// Squares at least this large are accurate, and remain accurate if a product loses 2^-100.
inline constexpr double kLeastSquare = 0x1p-900;

// `a` times the power of two that brings its max norm into [1, 2); `exponent` undoes it. Requires a finite a other
// than 0.
inline Vec3 normalised(const Vec3& a, int& exponent) {
  EXACTFF_EXPECT(kernel::is_finite(a) && !(a == Vec3{}));
  exponent = std::ilogb(max_norm(a));
  return {std::scalbn(a.x, -exponent), std::scalbn(a.y, -exponent), std::scalbn(a.z, -exponent)};
}

// Also correct where squares underflow. Requires components below 2^511.
inline double length(const Vec3& a) {
  const double square = dot(a, a);
  if (square >= kLeastSquare) return std::sqrt(square);
  if (a == Vec3{}) return 0.0;
  int exponent = 0;
  const Vec3 near_one = normalised(a, exponent);
  return std::scalbn(std::sqrt(dot(near_one, near_one)), exponent);
}

}  // namespace exactff::adaptive
