// Vectors of doubles, for estimates and pictures.
#pragma once

#include <algorithm>
#include <cmath>

#include "exactff/geometry.h"

namespace exactff::kernel {

inline double coordinate(const Vec3& a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }
inline Vec3 sum(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 difference(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 scaled(const Vec3& a, double factor) { return {a.x * factor, a.y * factor, a.z * factor}; }
// from + t direction
inline Vec3 along(const Vec3& from, const Vec3& direction, double t) {
  return {from.x + t * direction.x, from.y + t * direction.y, from.z + t * direction.z};
}
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// Requires squares that neither overflow nor vanish.
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline double distance(const Vec3& a, const Vec3& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline double max_norm(const Vec3& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

// --- Vectors of length 1, but for roundings. These three ways differ in the last bits. ---

// First divides by the largest component, so that squares neither overflow nor vanish. Zero stays zero.
inline Vec3 unit(const Vec3& a) {
  const double largest = max_norm(a);
  if (largest == 0.0) return a;
  const Vec3 safe{a.x / largest, a.y / largest, a.z / largest};
  const double size = length(safe);
  return {safe.x / size, safe.y / size, safe.z / size};
}
// The same with one inverse for all components.
inline Vec3 unit_by_inverse(const Vec3& a) {
  const double largest = max_norm(a);
  if (largest == 0.0) return a;
  const Vec3 safe{a.x / largest, a.y / largest, a.z / largest};
  return scaled(safe, 1.0 / length(safe));
}
// Requires a length and an inverse of it that are finite.
inline Vec3 unit_unscaled(const Vec3& a) { return scaled(a, 1.0 / std::hypot(a.x, a.y, a.z)); }

}  // namespace exactff::kernel
