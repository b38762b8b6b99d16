// Only this function clamps a sampled value to the range that its method promises.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/expect.h"

namespace exactff::adaptive {

enum class Formula {
  kUnit,         // all its values lie in [0, 1]; others are rounding errors
  kNotNegative,  // its values may exceed 1
  kAny,
};

// Requires a number, perhaps infinite: a formula may exceed the largest double. Returns the nearest finite double that
// the formula could have had without rounding errors.
[[nodiscard]] inline double move_into_range(double value, Formula formula) {
  EXACTFF_EXPECT(!std::isnan(value));
  constexpr double kLargest = std::numeric_limits<double>::max();
  constexpr double kRoundingAboveOne = 1e-12;  // sums of a method's terms exceed 1 by no more through rounding
  if (formula == Formula::kAny) return std::clamp(value, -kLargest, kLargest);
  const bool rounds_to_one = value <= 1.0 + kRoundingAboveOne || formula == Formula::kUnit;
  return std::min(std::max(0.0, value), rounds_to_one ? 1.0 : kLargest);  // -0 becomes 0
}

}  // namespace exactff::adaptive
