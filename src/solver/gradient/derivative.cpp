#include "gradient/derivative.h"

namespace exactff::gradient {

bool is_determined(const Ball& ball, Derivative& result) {
  EnclosureInside::set(result.enclosure, ball);
  if (result.enclosure.contains(0.0)) return false;
  const std::optional<double> nearest = result.enclosure.nearest();
  if (!nearest || !std::isfinite(*nearest)) return false;
  result.value = *nearest;
  result.status = result.value == 0.0 ? DerivativeStatus::kUnderflow : DerivativeStatus::kCertified;
  return true;
}

bool is_determined(double hi, double lo, double error, Derivative& result) {
  const Ball ball = kernel::ball_around(hi, lo, error);
  const std::optional<double> nearest = kernel::nearest_around(hi, lo, error);
  if (!nearest) return is_determined(ball, result);
  EnclosureInside::set(result.enclosure, ball);
  result.value = *nearest;
  result.status = DerivativeStatus::kCertified;
  return true;
}

void set_zero(Derivative& result) {
  result = {};
  EnclosureInside::set(result.enclosure, Ball());
}

void set_none(Derivative& result) {
  result.value = std::numeric_limits<double>::quiet_NaN();
  result.status = DerivativeStatus::kNone;
  EnclosureInside::set(result.enclosure, Ball());
}

Ball over_turn_and_length(const kernel::ExactVec3& n, long bits) {
  return kernel::to_ball(1.0, bits) / (twice(kernel::pi(bits)) * sqrt(kernel::to_ball(dot(n, n), bits)));
}

}  // namespace exactff::gradient
