#include "view_factors/looks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/poll.h"
#include "view_factors/near_planes.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kPointsOfStratum = kDraws;
static_assert(kPointsOfFirstLook >= kPointsOfStratum * kFewestStrata);
constexpr double kOfExpected = 0.95;     // of a width: what is expected is a little less
constexpr double kNarrower = 0.1;        // than the look before
constexpr double kLeastOfWidths = 0.75;  // of the width that is expected if the function is the same in every stratum
constexpr double kDecay = 1.5;           // of the square of a mean: the exponent of the number of strata
constexpr double kCaution = 1.7;         // so much more is expected than predicted
constexpr double kFirstSquare = 2.0;     // what the first look expects, in squares of the range

constexpr std::size_t kPointsOfSplit = 2 * kPointsOfStratum;  // more after a split than before, at most

double share_of(double risk, std::size_t look) { return risk / static_cast<double>(look * (look + 1)); }

// From one stratum; that from several is as many times smaller.
double width_of_one(double range, double risk) {
  return kLeastOfWidths * 2.0 * StratifiedMean().error(range, share_of(risk, 1));
}

}  // namespace

double least_width(double range, std::size_t strata, double risk) {
  return std::min(1.0, width_of_one(range, risk) / static_cast<double>(strata));
}

double points_for(double range, double width, double risk) {
  return static_cast<double>(kPointsOfStratum) * width_of_one(range, risk) / width;
}

double next_width(double width) {
  double next = 1.0;
  while (next >= width) next *= kNarrower;
  return next;
}

Looks::Looks(SampledFunction& function, const Units& units, double risk, std::size_t before, std::size_t first)
    : function_(function),
      units_(units),
      risk_(risk),
      of_shares_(error_of_shares(function.parts(), units)),
      strata_(function.parts(), first / kPointsOfStratum, [this](const Tile& tile) { return function_.range(tile); }),
      number_(before) {}

std::size_t Looks::points_of_next() const { return kPointsOfStratum * strata_.strata().strata.size(); }

double Looks::risk_of(std::size_t look) const { return share_of(risk_, look); }

// False if all points might then be more, or the strata are too small.
bool Looks::split_within(std::size_t points) {
  return points_after_next() + kPointsOfSplit <= points && strata_.split();
}

bool Looks::prepare(double width, std::uint64_t effort, std::size_t points) {
  if (!(width > 0.0)) return false;
  while (expected_width() > kOfExpected * width) {
    if (effort_after_next() > effort || !split_within(points)) return false;
  }
  return effort_after_next() <= effort && points_after_next() <= points;
}

bool Looks::prepare_for_all(std::size_t points) {
  while (split_within(points)) {
  }
  return points_after_next() <= points;
}

// Of the next look, from the ranges and the last look.
double Looks::expected_width() const {
  const auto error = [&](const StratifiedMean& last) {
    const double square = expected_square(last);
    return StratifiedMean{.expected = square, .square = square}.error(strata_.largest(), risk_of(number_ + 1));
  };
  return std::min(1.0, last_.most.value + error(last_.most)) - std::max(0.0, last_.least.value - error(last_.least));
}

Looks::Mean Looks::look() {
  Last next;
  next.strata = strata_.strata().strata.size();
  next.least.expected = expected_square(last_.least);
  next.most.expected = expected_square(last_.most);
  for (std::size_t s = 0; s < next.strata; ++s) {
    kernel::poll();
    add(s, next);
  }
  const bool is_first = points_ == 0;
  last_ = next;
  ++number_;
  points_ += points_of_next();
  if (is_first) effort_of_point_ = function_.effort() / points_;
  const auto error = [&](const StratifiedMean& mean) { return mean.error(strata_.largest(), risk_of(number_)); };
  const double below = error(last_.least), above = last_.most.value - last_.least.value + error(last_.most);
  return {last_.least.value, std::max(below, above) + of_shares_ + kRoundedPoints};
}

// Of the next look, from a mean of the last one.
double Looks::expected_square(const StratifiedMean& last) const {
  if (points_ == 0) return kFirstSquare * strata_.largest() * strata_.largest();
  const double ratio = static_cast<double>(last_.strata) / static_cast<double>(strata_.strata().strata.size());
  return kCaution * last.square * std::pow(ratio, kDecay);
}

void Looks::add(std::size_t stratum, Last& look) {
  const Strata& strata = strata_.strata();
  const double range = strata_.range(stratum);
  const double guess = points_ == 0 ? std::min(last_value_, range) : strata_.guess(stratum);
  std::array<double, kDraws> least{}, most{};
  for (std::size_t d = 0; d < kDraws; ++d) {
    Draws draws(number_, stratum, d);
    const Tile& tile = draw_tile(strata, strata.strata[stratum], d, draws);
    const Point point = point_in(function_.parts()[tile.part], tile, draws, units_);
    const std::optional<double> value = function_.at(point, tile.part);
    least[d] = value.value_or(0.0);
    most[d] = value.value_or(range);
  }
  const double share = strata.strata[stratum].area / strata.area;
  look.least.add(least[0], least[1], guess, share);
  look.most.add(most[0], most[1], guess, share);
  last_value_ = 0.5 * (least[0] + least[1]);
  strata_.set_guess(stratum, last_value_);
}

}  // namespace exactff::view_factors
