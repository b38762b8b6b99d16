#include "sampled/value_range.h"

#include <algorithm>
#include <limits>

namespace exactff::sampled {

namespace {

constexpr double kRoundingAboveOne = 1e-12;  // sums of a method's terms exceed 1 by no more than this through rounding

}  // namespace

double settled(double value, Formula formula) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  if (formula == Formula::kAny) return std::clamp(value, -kLargest, kLargest);
  const bool rounds_to_one = value <= 1.0 + kRoundingAboveOne || formula == Formula::kUnit;
  return std::min(std::max(0.0, value), rounds_to_one ? 1.0 : kLargest);  // -0 becomes 0
}

}  // namespace exactff::sampled
