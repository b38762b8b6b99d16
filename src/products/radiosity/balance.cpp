#include "radiosity/balance.h"

#include <algorithm>
#include <array>
#include <limits>

#include "kernel/outward.h"

namespace exactff::radiosity {
namespace {

using kernel::above;
using kernel::below;
using matrix::Sum;

constexpr std::array<Sum Balance::*, 3> kWays = {&Balance::absorbed, &Balance::back, &Balance::open};
constexpr double kRoundedAreas = 0x1p-44;  // relative; as in view_factors/view_factor.cpp

bool is_zero(const Sum& x) { return x.lower == 0.0 && x.upper == 0.0; }

// The interval of all sums. Zero is exact.
Sum operator+(const Sum& a, const Sum& b) {
  if (is_zero(a)) return b;
  if (is_zero(b)) return a;
  return {below(a.lower + b.lower), above(a.upper + b.upper)};
}

// The interval of all products with a number of [b.lower, b.upper], 0 <= b.lower. An upper bound may be infinite.
Sum times_nonnegative(const Sum& a, const Sum& b) {
  if (is_zero(a) || is_zero(b)) return {};
  const auto product = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; };
  return {below(std::min(product(a.lower, b.lower), product(a.lower, b.upper))),
          above(std::max(product(a.upper, b.lower), product(a.upper, b.upper)))};
}

Sum one_minus(double rho) { return rho == 1.0 ? Sum{} : Sum{below(1.0 - rho), above(1.0 - rho)}; }

Sum operator-(const Sum& a, const Sum& b) { return a + Sum{-b.upper, -b.lower}; }

Sum interval(const BoundedValue& q) { return {q.lower, q.upper}; }
Sum interval(const ViewFactor& f) { return {f.lower, f.upper}; }

}  // namespace

Balance sums_of(const Channel& channel, const System& system, const matrix::Matrix& matrix, const Laws& laws) {
  Balance balance;
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    const double given = matrix.factors.at(i, 0).area_from, emission = system.emissions[i];
    const Sum area{given * (1.0 - kRoundedAreas), given * (1.0 + kRoundedAreas)};
    const Sum leaving = times_nonnegative(interval(channel.radiosity[i]), area);
    const Sum arriving = times_nonnegative(interval(channel.irradiance[i]), area);
    balance.emitted = balance.emitted + times_nonnegative({emission, emission}, area);
    balance.absorbed = balance.absorbed + times_nonnegative(one_minus(system.reflectances[i]), arriving);
    balance.back = balance.back + times_nonnegative(leaving, interval(matrix.back[i]));
    balance.open = balance.open + times_nonnegative(leaving, interval(matrix.open[i]));
  }
  for (Sum* part : {&balance.emitted, &balance.back, &balance.open}) part->lower = std::max(0.0, part->lower);
  if (laws.loses_at_each_bounce) balance.absorbed.lower = std::max(0.0, balance.absorbed.lower);
  if (laws.is_finite) return balance;
  for (Sum Balance::*way : kWays) (balance.*way).upper = std::numeric_limits<double>::infinity();
  return balance;
}

bool is_contradiction(const Balance& sums) {
  const Sum gone = sums.absorbed + sums.back + sums.open;
  return gone.lower > sums.emitted.upper || gone.upper < sums.emitted.lower;
}

Balance clip(const Balance& sums, const Laws& laws) {
  Balance clipped = sums;
  if (!laws.adds_up || !(laws.is_finite || laws.loses_at_each_bounce)) return clipped;
  for (std::size_t k = 0; k < kWays.size(); ++k) {
    const Sum &a = sums.*kWays[(k + 1) % 3], &b = sums.*kWays[(k + 2) % 3], rest = sums.emitted - (a + b);
    Sum& part = clipped.*kWays[k];
    part.upper = std::min(part.upper, rest.upper);
    if (a.lower >= 0.0 && b.lower >= 0.0) part.upper = std::min(part.upper, sums.emitted.upper);  // without a rounding
    if (laws.is_finite) part.lower = std::max(part.lower, rest.lower);
  }
  return clipped;
}

bool is_balanced(const Solution& solution) {
  return std::ranges::all_of(solution.channels, [](const Channel& channel) { return channel.is_balanced; });
}

}  // namespace exactff::radiosity
