// Eq. (4) of F. Tampieri (1992) in plain double, in the three forms that programs use: the results of careful and of
// careless code. Each estimates the form factor of a region from its boundary.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/geometry.h"

namespace exactff::stress {

enum class AngleFormula {
  kAcos,             // unit vectors a and b, acos(a . b), a x b
  kAtan2,            // atan2(|a x b|, a . b)
  kAtan2Difference,  // the same, but a x b is computed as a x (b - a)
};

// A closed polygon, counter-clockwise seen from the front of the source; holes are clockwise.
using Polygon = std::vector<Vec3>;

// -1/(2 pi |n|) times the sum over the edges of angle n . (a x b) / |a x b|, with a and b relative to x. Nothing is
// clamped, but the angle of two unit vectors is 0 or pi if their product rounds beyond 1. An edge with a x b = 0 adds
// nothing.
[[nodiscard]] double form_factor_in_double(std::span<const Polygon> region, const Vec3& x, const Vec3& normal,
                                           AngleFormula formula);

}  // namespace exactff::stress
