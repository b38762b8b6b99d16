// Slopes of a form factor from values that are certified to many digits.
//
// F is analytic on each side of a movement's start. One-sided differences at steps h, h/2, h/4 therefore have an
// expansion in all powers of h, and two steps of Richardson's extrapolation leave an error of the order of h^3.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "kernel/ball.h"

namespace exactff::validation {

inline constexpr long kBits = 800;

inline Ball number(double value) { return kernel::to_ball(value, kBits); }
inline Ball ball_of(const Enclosure& enclosure) { return kernel::with_bits(EnclosureInside::ball(enclosure), kBits); }
inline double middle(const Ball& ball) { return kernel::nearest_to_midpoint(ball); }
inline Vec3 times(const Vec3& v, double s) { return {v.x * s, v.y * s, v.z * s}; }

// 2^-200 of the smallest coordinate. Nothing if the coordinates differ by more than a factor of 2^30: F may then bend
// within any step that doubles allow.
inline std::optional<double> step_for(const generate::PlainScene& plain) {
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  const auto take = [&](const Vec3& v) {
    for (const double c : {v.x, v.y, v.z}) {
      if (c != 0.0) least = std::min(least, std::abs(c));
      largest = std::max(largest, std::abs(c));
    }
  };
  for (const Vec3& v : plain.vertices) take(v);
  take(plain.point);
  if (!(least > 0x1p-300 && largest < 0x1p30 * least)) return std::nullopt;
  return std::ldexp(1.0, std::ilogb(least) - 200);
}

// The one-sided slope at 0 of value_at, a ball for every number of at least 0.
template <class ValueAt>
double slope_of(const ValueAt& value_at, double step) {
  std::array<Ball, 3> table;
  const Ball here = value_at(0.0);
  for (double h = step; Ball & entry : table) {
    entry = (value_at(h) - here) / number(h);
    h *= 0.5;
  }
  for (const double order : {2.0, 4.0}) {
    for (std::size_t i = table.size() - 1; i > 0; --i) {
      table[i] = (number(order) * table[i] - table[i - 1]) / number(order - 1.0);
    }
  }
  return middle(table.back());
}

// Up to the sign. One that is only enclosed may have other bounds, or be found.
inline bool same(const Derivative& a, const Derivative& b, double sign) {
  if (a.status == DerivativeStatus::kNone || b.status == DerivativeStatus::kNone) return a.status == b.status;
  if (a.status == DerivativeStatus::kEnclosed || b.status == DerivativeStatus::kEnclosed) return true;
  return a.status == b.status && a.value == sign * b.value;
}

}  // namespace exactff::validation
