// The oracle's arithmetic: exact vectors, and Lambert's sum over convex polygons seen from the origin.
#pragma once

#include <gmpxx.h>

#include <array>
#include <string>
#include <vector>

namespace exactff::validation {

using Rational = mpq_class;
using Vector = std::array<Rational, 3>;
using Corners = std::vector<Vector>;

inline Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector negative(const Vector& a) { return {-a[0], -a[1], -a[2]}; }
inline Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool is_zero(const Vector& a) { return sgn(a[0]) == 0 && sgn(a[1]) == 0 && sgn(a[2]) == 0; }

struct RoundedSum {
  double value = 0.0;    // nearest double
  std::string decimals;  // 30 significant digits, correctly rounded
  Rational low = 0;      // low <= sum <= high
  Rational high = 0;
};

// The sum of the form factors of the polygons, for a receiver at the origin with normal n. Each polygon must be convex,
// above the horizon of n and in a plane that does not contain the origin. Its orientation does not matter.
[[nodiscard]] RoundedSum lambert_sum(const std::vector<Corners>& polygons, const Vector& n);

// What measure_sum integrates over the polygons.
struct SumMeasure {
  enum class Kind { kSolidAngle, kSphere, kOvercast } kind = Kind::kSolidAngle;  // as exactff/exact.h
  Vector up{};
};
// The sum of another measure. The same requirements, for the overcast sky above both horizons; for a solid angle, there
// need be no normal.
[[nodiscard]] RoundedSum measure_sum(const std::vector<Corners>& polygons, const Vector& n, const SumMeasure& measure);

// low <= that sum <= high, computed with so many bits.
struct SumBounds {
  Rational low, high;
};
[[nodiscard]] SumBounds bounds_of_lambert_sum(const std::vector<Corners>& polygons, const Vector& n, long bits);

// For one plane: areas seen along an axis, and the square of the factor that converts them to true areas.
struct Share {
  Rational visible;
  Rational whole;
  Rational squared_factor;
};

// The visible area of all planes divided by the area of all planes, rounded to the nearest double, ties to even; 0 if
// there are no planes.
[[nodiscard]] double rounded_share(const std::vector<Share>& shares);

}  // namespace exactff::validation
