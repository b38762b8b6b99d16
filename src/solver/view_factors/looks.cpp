#include "view_factors/looks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/poll.h"
#include "kernel/vec.h"
#include "view_factors/near_planes.h"
#include "view_factors/point_factors.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kPointsOfStratum = kDraws;
static_assert(kPointsOfFirstLook >= kPointsOfStratum * kFewestStrata);
constexpr double kOfExpected = 0.95;     // of a width: what is expected is a little less
constexpr double kNarrower = 0.1;        // than the look before
constexpr double kLeastOfWidths = 0.75;  // of the width that is expected if the function is the same in every stratum
constexpr double kOffSquare = 0.65;      // of what a stratum adds to it, less when the stratum is split
constexpr double kCaution = 1.7;         // so much more is expected than predicted
constexpr double kFirstSquare = 8.0;     // what the first look expects, in squares of r
constexpr double kOfDraws = 0x1p-31;     // the mean of a guess is that at the middle of its tile, within less

constexpr double kFarthestShare = 2.0 / 3.0;  // of a side, from the middle of a tile to its corners, at most

constexpr std::size_t kPointsOfSplit = 2 * kPointsOfStratum;  // more after a split than before, at most

double share_of(double risk, std::size_t look) { return risk / static_cast<double>(look * (look + 1)); }

// From one stratum; that from several is as many times smaller.
double width_of_one(double range, double risk) {
  return kLeastOfWidths * 2.0 * StratifiedMean().error(range / kDraws, share_of(risk, 1));
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
      strata_(function.parts(), first / kPointsOfStratum,
              [this](const Tile& tile, bool is_alone) { return function_.span(tile, is_alone); }),
      planes_(function.parts()),
      number_(before) {}

std::size_t Looks::points_of_next() const { return kPointsOfStratum * strata_.strata().strata.size(); }

double Looks::risk_of(std::size_t look) const { return share_of(risk_, look); }

double Looks::expected_error(double r, double square) const {
  return StratifiedMean{.expected = square, .square = square}.error(r, risk_of(number_ + 1));
}

// To split a stratum for its square, rather than for its term: the terms are about equal, so they fall as their number
// grows.
bool Looks::prefers_square() const {
  const double r = strata_.largest_term(), square = expected_square();
  const double less = square - kCaution * kOffSquare * strata_.largest_square();
  return expected_error(r, std::max(0.0, less)) <
         expected_error(r * (1.0 - 1.0 / static_cast<double>(strata_.strata().strata.size())), square);
}

// False if all points might then be more, or the strata are too small.
bool Looks::split_within(std::size_t points) {
  kernel::poll();
  if (points_after_next() + kPointsOfSplit > points) return false;
  return prefers_square() ? strata_.split_largest_square() : strata_.split_largest_term();
}

bool Looks::prepare(double width, std::uint64_t effort, std::size_t points) {
  // More points rarely help where the function is not known.
  if (!(width > last_.most.value - last_.least.value)) return false;
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

// Of the next look, from what is proved of the function and from the last look.
double Looks::expected_width() const {
  const double error = expected_error(strata_.largest_term(), expected_square());
  return std::min(1.0, last_.most.value + error) - std::max(0.0, last_.least.value - error);
}

Looks::Mean Looks::look() {
  Last next;
  next.strata = strata_.strata().strata.size();
  next.least.expected = next.most.expected = expected_square();
  const double r = strata_.largest_term();
  for (std::size_t s = 0; s < next.strata; ++s) {
    kernel::poll();
    add(s, next);
  }
  const bool is_first = points_ == 0;
  last_ = next;
  ++number_;
  points_ += points_of_next();
  if (is_first) effort_of_point_ = std::max(kLeastEffort, function_.effort() / points_);
  const auto error = [&](const StratifiedMean& mean) { return mean.error(r, risk_of(number_)); };
  const double lower = last_.least.value - error(last_.least), upper = last_.most.value + error(last_.most);
  return {0.5 * (lower + upper), 0.5 * (upper - lower) + of_shares_ + kRoundedPoints + kOfDraws};
}

// Of the next look, from the last one.
double Looks::expected_square() const {
  if (points_ == 0) return kFirstSquare * strata_.largest_term() * strata_.largest_term();
  return kCaution * strata_.sum_of_squares();
}

// A linear function on a tile, by shares of its sides.
struct Looks::Guess {
  double value = 0.0;  // at the middle
  Place middle, slope;

  [[nodiscard]] double at(const Place& place) const {
    return value + slope.along * (place.along - middle.along) + slope.up * (place.up - middle.up);
  }
  // With a change of at most this on the tile.
  void flatten(double most) {
    const double change = (std::abs(slope.along) + std::abs(slope.up)) * kFarthestShare;
    if (!(change < HUGE_VAL)) slope = {};
    if (change > most) slope = {slope.along * most / change, slope.up * most / change};
  }
};

Looks::Guess Looks::guess_on(const Tile& tile) const {
  Guess guess{.value = last_number_, .middle = middle_of(tile), .slope = {}};
  const Sides sides = sides_of(function_.parts()[tile.part], tile);
  const std::optional<LocalPlanes::Plane> plane = planes_.about(tile.part, sides.at(guess.middle));
  if (!plane || !std::isfinite(plane->value)) return guess;
  guess.value = plane->value;
  guess.slope = {kernel::dot(plane->gradient, sides.along), kernel::dot(plane->gradient, sides.up)};
  return guess;
}

std::optional<double> Looks::number_at(const Tile& tile, const Place& place) {
  const Point point = point_at(function_.parts()[tile.part], tile, place, units_);
  const std::optional<double> number = function_.at(point, tile.part);
  if (number) {
    planes_.add(tile.part, point.at, *number);
    last_number_ = *number;
  }
  return number;
}

void Looks::add(std::size_t stratum, Last& look) {
  const double before = look.most.square;
  strata_.is_by_middle(stratum) ? add_by_middle(stratum, look) : add_by_draws(stratum, look);
  strata_.set_square(stratum, look.most.square - before);
}

// The guess is what the function is at the middle, and what has been seen nearby says how it changes from there. If it
// is not known at the middle, the least that it may be adds nothing. Numbers are rounded, and clamped to what is
// proved.
void Looks::add_by_middle(std::size_t stratum, Last& look) {
  const Strata& strata = strata_.strata();
  const Stratum& whole = strata.strata[stratum];
  const Tile& tile = strata.tiles[whole.begin];
  const double share = whole.area / strata.area;
  const auto [range, change] = strata_.span(stratum);
  const std::optional<double> at_middle = number_at(tile, middle_of(tile));
  if (!at_middle) return look.most.add(range, range, range, share);
  Guess guess = guess_on(tile);
  guess.value = *at_middle;
  guess.flatten((kOverChange - 1.0) * change);
  Draws draws(number_, stratum, 0);
  const Place place = draw_place(tile, draws);
  const double lowest = *at_middle - change, highest = *at_middle + change;
  const std::optional<double> number = number_at(tile, place);
  look.least.add(std::clamp(number.value_or(lowest), lowest, highest), guess.at(place), guess.value, share);
  look.most.add(std::clamp(number.value_or(highest), lowest, highest), guess.at(place), guess.value, share);
}

// Guesses lie within the range. Where a stratum has several tiles, they are the same on all of these.
void Looks::add_by_draws(std::size_t stratum, Last& look) {
  const Strata& strata = strata_.strata();
  const Stratum& whole = strata.strata[stratum];
  const double range = strata_.span(stratum).range, share = whole.area / strata.area / kDraws;
  const bool is_single = whole.end == whole.begin + 1;
  for (std::size_t d = 0; d < kDraws; ++d) {
    Draws draws(number_, stratum, d);
    const Tile& tile = draw_tile(strata, whole, d, draws);
    Guess guess = is_single ? guess_on(tile) : Guess{last_number_, {}, {}};
    guess.value = std::clamp(guess.value, 0.0, range);
    guess.flatten(std::min(guess.value, range - guess.value));
    const Place place = draw_place(tile, draws);
    const std::optional<double> number = number_at(tile, place);
    look.least.add(std::clamp(number.value_or(0.0), 0.0, range), guess.at(place), guess.value, share);
    look.most.add(std::clamp(number.value_or(range), 0.0, range), guess.at(place), guess.value, share);
  }
}

}  // namespace exactff::view_factors
