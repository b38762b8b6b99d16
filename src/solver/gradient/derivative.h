// One derivative: from a ball, or from sums of arcs in balls of rising precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contour/arc_sum.h"
#include "exactff/exact.h"
#include "kernel/ball.h"

namespace exactff::gradient {

inline constexpr int kQuickBits = 106;  // of double-double

// Takes the double from a ball, unless it contains 0. False if the ball does not determine it.
[[nodiscard]] bool is_determined(const Ball& ball, Derivative& result);
// Of a number within `error` of hi + lo.
[[nodiscard]] bool is_determined(double hi, double lo, double error, Derivative& result);
void set_zero(Derivative& result);
void set_none(Derivative& result);

// The sum of the terms times `factor`, which has as many bits as it is asked for.
template <class Factor>
void certify(const contour::ArcSum& sum, const Factor& factor, int cap, Derivative& result) {
  if (sum.cancels()) {
    set_zero(result);
    return;
  }
  constexpr int kFirstBits = 128;
  constexpr long kBitsForZero = 256;  // a ball that still contains 0 at this precision is the result
  for (int bits = std::min(kFirstBits, cap);; bits = std::min(2 * bits, cap)) {
    const Ball ball = sum.evaluate(bits) * factor(bits);
    if (is_determined(ball, result)) return;
    const bool holds_zero = result.enclosure.contains(0.0);
    if (bits < cap && !(holds_zero && bits >= kBitsForZero)) {
      const std::optional<double> nearest = result.enclosure.nearest();
      if (!nearest || std::isfinite(*nearest)) continue;  // a larger precision does not help beyond the doubles
    }
    result.status = DerivativeStatus::kEnclosed;
    constexpr double kLargest = std::numeric_limits<double>::max();
    result.value = holds_zero ? 0.0 : std::clamp(kernel::nearest_to_midpoint(ball), -kLargest, kLargest);
    return;
  }
}

// 1 / (2 pi |n|).
[[nodiscard]] Ball over_turn_and_length(const kernel::ExactVec3& n, long bits);

}  // namespace exactff::gradient
