#include "kernel/filter.h"

#include <limits>

#include "kernel/vec.h"

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

InverseDepth inverse_depth(const Approx3& e, const Approx3& f, const Approx3& s) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double size_e = max_norm(e), size_f = max_norm(f), size_s = max_norm(s);
  for (const double size : {size_e, size_f, size_s}) {
    if (!(size >= 0x1p-200 && size <= 0x1p200)) return {{}, kInfinity};
  }
  const Approx3 n{e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
  const double c = n.x * s.x + n.y * s.y + n.z * s.z;
  const double area = size_e * size_f, error_c = 0x1p-47 * area * size_s;
  if (!(std::abs(c) > 4.0 * error_c)) return {{}, kInfinity};
  const Vec3 slope{n.x / c, n.y / c, n.z / c};
  const double steepness = max_norm(slope);
  const double component = (0x1p-50 * area + steepness * error_c) / (std::abs(c) - error_c) + 0x1p-53 * steepness;
  const double error = 1.001 * (3.0 * component + 0x1p-48 * steepness);
  return std::isfinite(error) ? InverseDepth{slope, error} : InverseDepth{{}, kInfinity};
}

}  // namespace exactff::kernel
