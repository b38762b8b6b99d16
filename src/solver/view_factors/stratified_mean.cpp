#include "view_factors/stratified_mean.h"

#include <algorithm>
#include <cmath>

namespace exactff::view_factors {
namespace {

constexpr double kLeastExpected = 0.25;         // in squares of r; what is less hardly matters
constexpr double kOfRoundings = 1.0 + 0x1p-40;  // far more than there are

// About the c that makes e least: c / (1 - c) + log(1 - c) = L / q, with q the square that is expected, over r^2.
double best_c(double l, double q) {
  const double ratio = l / std::max(kLeastExpected, q), odds = std::sqrt(2.0 * ratio) + ratio;
  return odds / (1.0 + odds);
}

}  // namespace

void StratifiedMean::add(double number, double guess, double mean_of_guess, double share) {
  const double off = share * (number - guess);
  value += share * mean_of_guess + off;
  square += off * off;
}

// Either direction has half of the risk.
double StratifiedMean::error(double r, double risk) const {
  if (r == 0.0) return 0.0;
  const double l = std::log(2.0 / risk), c = best_c(l, expected / r / r);
  const double psi = -std::log1p(-c) - c;
  return (r * l + psi * square / r) / c * kOfRoundings;
}

}  // namespace exactff::view_factors
