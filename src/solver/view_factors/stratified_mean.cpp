#include "view_factors/stratified_mean.h"

#include <algorithm>
#include <cmath>

namespace exactff::view_factors {
namespace {

constexpr double kLeastExpected = 0.25;         // in squares of r; what is less hardly matters
constexpr double kOfRoundings = 1.0 + 0x1p-40;  // far more than there are

// About the c that makes e least: c / (1 - c) + log(1 - c) = L / q, with q the square that is expected, over r^2.
double best_c(double l, double q) {
  const double ratio = l / std::max(q, kLeastExpected), odds = std::sqrt(2.0 * ratio) + ratio;
  return odds / (1.0 + odds);
}

}  // namespace

void StratifiedMean::add(double a, double b, double guess, double share) {
  const double half = 0.5 * share, of_a = half * (a - guess), of_b = half * (b - a);
  value += half * (a + b);
  square += of_a * of_a + of_b * of_b;
}

// Either direction has half of the risk.
double StratifiedMean::error(double largest, double risk) const {
  if (largest == 0.0) return 0.0;
  const double l = std::log(2.0 / risk), r = 0.5 * largest, c = best_c(l, expected / (r * r));
  const double psi = -std::log1p(-c) - c;
  return (r * l + psi * square / r) / c * kOfRoundings;
}

}  // namespace exactff::view_factors
