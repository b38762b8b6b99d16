#include "kernel/filter.h"

#include <limits>

namespace exactff::kernel {

Approx3 approx(const ExactVec3& exact) {
  std::array<double, 3> mantissa{};
  std::array<long, 3> exponent{};
  long largest = std::numeric_limits<long>::min();
  for (int axis = 0; axis < 3; ++axis) {
    // Truncated to 53 bits: relative error below 2u.
    mantissa[axis] = mpz_get_d_2exp(&exponent[axis], exact[axis].get_mpz_t());
    if (mantissa[axis] != 0.0) largest = std::max(largest, exponent[axis]);
  }
  constexpr long kSafeSpan = 900;
  const auto scaled = [&](int axis) {
    if (mantissa[axis] == 0.0) return 0.0;
    if (largest - exponent[axis] > kSafeSpan) return std::numeric_limits<double>::quiet_NaN();
    return std::ldexp(mantissa[axis], static_cast<int>(exponent[axis] - largest));
  };
  return {scaled(0), scaled(1), scaled(2)};
}

}  // namespace exactff::kernel
