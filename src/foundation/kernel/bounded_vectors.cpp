#include "kernel/bounded_vectors.h"

#include "kernel/ball.h"

namespace exactff::kernel::double_double {

namespace {

constexpr long kAngleBits = 160;

// The relative error is at most 2^-106: two roundings to nearest.
DoubleDouble rounded(const Ball& ball) {
  const double hi = nearest_to_midpoint(ball);
  return {hi, nearest_to_midpoint(ball - to_ball(hi, kAngleBits))};
}

AngleConstants compute_constants() {
  AngleConstants result;
  for (int k = 0; k <= kAtanSteps; ++k) {
    result.atan[k] = rounded(atan(to_ball(static_cast<double>(k) / kAtanSteps, kAngleBits)));
  }
  result.pi = rounded(kernel::pi(kAngleBits));
  result.half_pi = {0.5 * result.pi.hi, 0.5 * result.pi.lo};
  return result;
}

}  // namespace

const AngleConstants& angle_constants() {
  static const AngleConstants instance = compute_constants();
  return instance;
}

}  // namespace exactff::kernel::double_double
