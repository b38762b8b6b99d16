#include "kernel/disc.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace exactff::kernel {
namespace {

// 1 / (2k + 1), each rounded once.
constexpr std::size_t kTerms = 12;
constexpr std::array<double, kTerms> kCoefficients = [] {
  std::array<double, kTerms> result{};
  for (std::size_t k = 0; k < kTerms; ++k) result[k] = 1.0 / static_cast<double>(2 * k + 1);
  return result;
}();

// A(m) for a double m >= -1/2 by atan(y) = 2 atan(y / (1 + sqrt(1 + y^2))), which for m = y^2 is
//   A(m) = 2 / g * A(m / g^2),   g = 1 + sqrt(1 + m),
// three times, and the alternating series A(w) = sum of (-w)^k / (2k + 1).
//
// m / g^2 = (sqrt(1 + m) - 1) / (sqrt(1 + m) + 1) lies in (-0.172, 1); after the second time in (-0.048, 0.172), after
// the third in (-0.0121, 0.0396). So the first term left out, w^12 / 25, is below 2^-60, and so is their sum.
//
// Roundings. Suppose that m has a relative error of h u. Then 1 + m has at most h u |m| / (1 + m) + u, less than
// (h + 1) u, since |m| <= 1 + m; its root has less than (h / 2 + 2) u and g, of whose two terms the root is one,
// (h / 2 + 3) u. So w = m / g / g has (2h + 8.1) u. From h = 0 we get 8.1, 24.3, 56.7 for the three w, and 3, 7.1, 15.2
// for the three g, hence 30 u for the three factors 2 / g with their quotients and products. Since |A'| <= 0.34 near
// w, the error of w changes the series by at most 0.34 * 0.04 * 57 u < u; Horner's scheme adds less than 3 u. Together
// 35 u, since all three factors 2 / g and the series are positive; 64 u is used, and 2^-60 is below u.
constexpr double kRelativeError = 0x1p-47;
double atan_of_root_in_double(double m) {
  double factor = 1.0, w = m;
  for (int i = 0; i < 3; ++i) {
    const double g = 1.0 + std::sqrt(1.0 + w);
    factor *= 2.0 / g;
    w = w / g / g;
  }
  double sum = kCoefficients[kTerms - 1];
  for (std::size_t k = kTerms - 1; k-- > 0;) sum = kCoefficients[k] - w * sum;
  return factor * sum;
}

}  // namespace

Disc atan_of_root(const Disc& a) {
  const double least = a.centre - a.radius;  // wrong by at most u |least|
  if (!(a.centre >= -0.5) || !(least > -0.75)) return disc::kFailed;
  const double c = atan_of_root_in_double(a.centre);
  const double divisor = 3.0 * std::min(1.0, 1.0 + least) * std::min(1.0, 1.0 + a.centre);
  return {c, (a.radius / divisor + kRelativeError * c) * disc::kUp + disc::kTiny};
}

}  // namespace exactff::kernel
