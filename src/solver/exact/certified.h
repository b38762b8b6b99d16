// From balls to a certified value: its double, its bounds and its status. A Result has the members value, lower, upper,
// status, enclosure and precision_bits of a FormFactor.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactff/exact.h"
#include "kernel/ball.h"

namespace exactff::exact {

inline bool has_decimals(const Enclosure& enclosure, int digits) {
  return digits <= 0 || enclosure.decimals(digits).has_value();
}

// Takes the value from a ball computed with this precision. False if the ball does not determine the double and the
// requested decimals.
template <class Result>
bool is_determined(const Ball& ball, int bits, int digits, Result& result) {
  EnclosureInside::set(result.enclosure, ball);
  result.precision_bits = bits;
  const std::optional<double> nearest = result.enclosure.nearest();
  if (!nearest || !has_decimals(result.enclosure, digits)) return false;
  result.value = *nearest;
  result.status = result.value == 0.0 ? Status::kUnderflow : Status::kCertified;
  return true;
}

// Raises the precision until the ball determines the double and the requested decimals, or the cap is reached. The
// status refers to the double: decimals may stay undecided if F is a decimal tie, such as 1/8 to two digits.
template <class Evaluate, class Result>
void certify(const Evaluate& evaluate, int digits, int cap, Result& result) {
  constexpr int kFirstBits = 96;  // enough for all but the near-degenerate
  for (int bits = std::min(kFirstBits, cap);; bits = std::min(2 * bits, cap)) {
    const Ball ball = evaluate(bits);
    if (is_determined(ball, bits, digits, result)) return;
    if (bits < cap) continue;
    const std::optional<double> nearest = result.enclosure.nearest();
    result.value = nearest ? *nearest : std::clamp(kernel::nearest_to_midpoint(ball), 0.0, 1.0);
    result.status = !nearest ? Status::kNotCertified : result.value == 0.0 ? Status::kUnderflow : Status::kCertified;
    return;
  }
}

// With very few bits a ball may contain every number; its midpoint and ends are then NaN.
template <class Result>
void set_bounds(Result& result) {
  if (result.status == Status::kZero) return;  // [0, 0]
  const bool certified = result.status != Status::kNotCertified;
  const double below = certified ? std::nextafter(result.value, -1.0) : result.enclosure.lower();
  const double above = certified ? std::nextafter(result.value, 2.0) : result.enclosure.upper();
  result.lower = std::isnan(below) ? 0.0 : std::clamp(below, 0.0, 1.0);
  result.upper = std::isnan(above) ? 1.0 : std::clamp(above, 0.0, 1.0);
  if (std::isnan(result.value)) result.value = 0.5 * (result.lower + result.upper);
}

}  // namespace exactff::exact
