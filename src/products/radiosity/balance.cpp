#include "radiosity/balance.h"

#include <algorithm>
#include <array>
#include <limits>

#include "kernel/float_environment.h"
#include "matrix/surroundings.h"

namespace exactff::radiosity {
namespace {

using kernel::above;
using kernel::below;
using matrix::Sum;

constexpr std::array<Sum Balance::*, 4> kWays = {&Balance::absorbed, &Balance::back, &Balance::open, &Balance::lost};
constexpr double kRoundedAreas = 0x1p-44;  // relative; as in view_factors/pairs.cpp

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

// What both hold. Empty, with lower > upper, if that is nothing.
Sum common(const Sum& a, const Sum& b) { return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)}; }

Sum interval(const BoundedValue& q) { return {q.lower, q.upper}; }
Sum interval(const ViewFactor& f) { return {f.lower, f.upper}; }

constexpr Sum kAnyShare{0.0, 1.0};

Sum row_to_patches(const matrix::Factors& factors, std::size_t row) {
  Sum sum;
  for (std::size_t j = 0; j < factors.to.size(); ++j) sum = sum + interval(factors.at(row, j));
  return sum;
}

}  // namespace

Losses losses_of(const Scene& scene, const matrix::Matrix& matrix, bool adds_up) {
  const bool knows_all = !matrix.back.empty() && !matrix.open.empty();
  const matrix::ProvedZeros zeros =
      knows_all ? matrix::ProvedZeros{} : matrix::proved_zeros(scene, matrix.factors.from);
  Losses losses;
  for (std::size_t i = 0; i < matrix.factors.from.size(); ++i) {
    if (matrix.factors.at(i, 0).area_from == 0.0) {  // buried as a whole
      for (auto* of : {&losses.back, &losses.open, &losses.lost}) of->emplace_back();
      continue;
    }
    const auto share = [i](const std::vector<ViewFactor>& computed, const std::vector<bool>& is_zero) {
      return !computed.empty() ? interval(computed[i]) : is_zero[i] ? Sum{} : kAnyShare;
    };
    Sum back = share(matrix.back, zeros.back), open = share(matrix.open, zeros.open), lost = back + open;
    const Sum left = adds_up ? common(lost, Sum{1.0, 1.0} - row_to_patches(matrix.factors, i)) : lost;
    if (left.lower > left.upper) {
      losses.is_possible = false;
    } else {
      lost = common(left, kAnyShare);
      const Sum of_back = lost - open, of_open = lost - back;
      back = common(back, {of_back.lower, lost.upper});
      open = common(open, {of_open.lower, lost.upper});
    }
    losses.back.push_back(back);
    losses.open.push_back(open);
    losses.lost.push_back(lost);
  }
  return losses;
}

Balance sums_of(const Channel& channel, const System& system, const std::vector<double>& areas, const Losses& losses,
                const Laws& laws) {
  Balance balance;
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    const double given = areas[i], emission = system.emissions[i];
    const Sum area{given * (1.0 - kRoundedAreas), given * (1.0 + kRoundedAreas)};
    const Sum leaving = times_nonnegative(interval(channel.radiosity[i]), area);
    const Sum arriving = times_nonnegative(interval(channel.irradiance[i]), area);
    balance.emitted = balance.emitted + times_nonnegative({emission, emission}, area);
    balance.absorbed = balance.absorbed + times_nonnegative(one_minus(system.reflectances[i]), arriving);
    balance.back = balance.back + times_nonnegative(leaving, losses.back[i]);
    balance.open = balance.open + times_nonnegative(leaving, losses.open[i]);
    balance.lost = balance.lost + times_nonnegative(leaving, losses.lost[i]);
  }
  for (Sum* part : {&balance.emitted, &balance.back, &balance.open, &balance.lost})
    part->lower = std::max(0.0, part->lower);
  if (laws.loses_at_each_bounce) balance.absorbed.lower = std::max(0.0, balance.absorbed.lower);
  if (laws.is_finite) return balance;
  for (Sum Balance::*way : kWays) (balance.*way).upper = std::numeric_limits<double>::infinity();
  return balance;
}

bool is_contradiction(const Balance& sums) {
  const Sum gone = sums.absorbed + sums.lost;
  return gone.lower > sums.emitted.upper || gone.upper < sums.emitted.lower;
}

namespace {

// By what the other parts leave of what is emitted.
void clip(Sum& part, const Sum& a, const Sum& b, const Sum& emitted, const Laws& laws) {
  const Sum rest = emitted - (a + b);
  part.upper = std::min(part.upper, rest.upper);
  if (a.lower >= 0.0 && b.lower >= 0.0) part.upper = std::min(part.upper, emitted.upper);  // without a rounding
  if (laws.is_finite) part.lower = std::max(part.lower, rest.lower);
}

}  // namespace

Balance clip(const Balance& sums, const Laws& laws) {
  Balance clipped = sums;
  if (!laws.adds_up || !(laws.is_finite || laws.loses_at_each_bounce)) return clipped;
  clip(clipped.absorbed, sums.lost, {}, sums.emitted, laws);
  clip(clipped.lost, sums.absorbed, {}, sums.emitted, laws);
  clip(clipped.back, sums.absorbed, sums.open, sums.emitted, laws);
  clip(clipped.open, sums.absorbed, sums.back, sums.emitted, laws);
  return clipped;
}

bool is_balanced(const Solution& solution) {
  return std::ranges::all_of(solution.channels, [](const Channel& channel) { return channel.is_balanced; });
}

}  // namespace exactff::radiosity
