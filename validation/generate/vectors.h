// Sums and multiples of vectors, rounded, for making scenes.
#pragma once

#include "exactff/geometry.h"

namespace exactff::models {

[[nodiscard]] inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
[[nodiscard]] inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
[[nodiscard]] inline Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
[[nodiscard]] inline Vec3 operator*(const Vec3& a, double s) { return s * a; }

}  // namespace exactff::models
