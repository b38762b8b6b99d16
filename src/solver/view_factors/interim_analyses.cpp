#include "view_factors/interim_analyses.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/poll.h"
#include "view_factors/cell.h"
#include "view_factors/point_factors.h"

namespace exactff::view_factors {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
// What these are hardly matters. `matrix --threads 1` took 169,102 points `--from floor --accuracy 1e-3` in
// blinds_room.obj and 58,046 `--from 'H*' --accuracy 1e-2` in gunter2.vs3; with one of these halved, doubled or, if
// below 1, ten times as large or small, 0.98 to 1.05 and 0.99 to 1.12 times as many. With means in place of
// planes: 1.19 and 1.11 times.
constexpr std::size_t kNearest = 8, kFewestOfPlane = 4;
constexpr std::size_t kOfBox = 4;       // values, on average, before there are more boxes: one each
constexpr std::size_t kMostOfBox = 16;  // the newest ones of a box that are looked at
constexpr double kAtPlace = 0.05;       // of the farthest one's squared distance, added to each: no weight is too large
constexpr double kThin = 1e-4;          // of values along a line

std::uint32_t clamped(double x, std::uint32_t count) {
  return x > 0.0 ? static_cast<std::uint32_t>(std::min(x, static_cast<double>(count - 1))) : 0U;
}

}  // namespace

void LocalPlanes::prepare(const Part& part, Shown& shown) {
  const std::vector<Vec3> ring = positions_of(part.corners);
  shown.origin = ring[0];
  Vec3 normal;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    normal = kernel::sum(normal,
                         kernel::cross(kernel::difference(ring[i], ring[0]), kernel::difference(ring[i + 1], ring[0])));
  }
  shown.along_u = kernel::unit(kernel::difference(ring[1], ring[0]));
  shown.along_v = kernel::cross(kernel::unit(normal), shown.along_u);
  double high_u = 0.0, high_v = 0.0;
  shown.low_u = shown.low_v = 0.0;
  for (const Vec3& corner : ring) {
    const Vec3 from = kernel::difference(corner, shown.origin);
    const double u = kernel::dot(from, shown.along_u), v = kernel::dot(from, shown.along_v);
    shown.low_u = std::min(shown.low_u, u);
    shown.low_v = std::min(shown.low_v, v);
    high_u = std::max(high_u, u);
    high_v = std::max(high_v, v);
  }
  shown.width = high_u - shown.low_u;
  shown.height = high_v - shown.low_v;
}

std::uint32_t& LocalPlanes::box_of(Shown& shown, const Value& value) {
  const std::uint32_t column = clamped((value.u - shown.low_u) / shown.size, shown.columns),
                      row = clamped((value.v - shown.low_v) / shown.size, shown.rows);
  return shown.first[std::size_t{row} * shown.columns + column];
}

void LocalPlanes::make_grid(Shown& shown) {
  const double boxes = static_cast<double>(shown.values.size());
  shown.size = std::max(std::sqrt(shown.width * shown.height / boxes), std::max(shown.width, shown.height) / boxes);
  shown.columns = 1 + clamped(shown.width / shown.size, 1U << 20);
  shown.rows = 1 + clamped(shown.height / shown.size, 1U << 20);
  shown.first.assign(std::size_t{shown.columns} * shown.rows, kNone);
  shown.next_grid = kOfBox * shown.values.size();
  for (std::uint32_t i = 0; i < shown.values.size(); ++i) {
    Value& value = shown.values[i];
    std::uint32_t& first = box_of(shown, value);
    value.next = first;
    first = i;
  }
}

void LocalPlanes::add(std::size_t part, const Vec3& at, double value) {
  Shown& shown = shown_[part];
  if (shown.values.empty()) prepare(parts_[part], shown);
  const Vec3 from = kernel::difference(at, shown.origin);
  shown.values.push_back({kernel::dot(from, shown.along_u), kernel::dot(from, shown.along_v), value, kNone});
  if (shown.values.size() >= shown.next_grid) return make_grid(shown);
  std::uint32_t& first = box_of(shown, shown.values.back());
  shown.values.back().next = first;
  first = static_cast<std::uint32_t>(shown.values.size() - 1);
}

// The nearest, more or less: of those in the box of the place and around it, until there are enough, and once more
// around.
void LocalPlanes::find_near(const Shown& shown, double u, double v, std::vector<Near>& near) {
  const auto column = static_cast<std::int64_t>(clamped((u - shown.low_u) / shown.size, shown.columns)),
             row = static_cast<std::int64_t>(clamped((v - shown.low_v) / shown.size, shown.rows));
  const std::int64_t columns = shown.columns, rows = shown.rows;
  const auto add_box = [&](std::int64_t c, std::int64_t r) {
    if (c < 0 || c >= columns) return;
    std::size_t left = kMostOfBox;
    for (std::uint32_t i = shown.first[static_cast<std::size_t>(r * columns + c)]; i != kNone && left > 0;
         i = shown.values[i].next, --left) {
      const double du = shown.values[i].u - u, dv = shown.values[i].v - v;
      near.push_back({du, dv, shown.values[i].value, du * du + dv * dv});
    }
  };
  bool is_last = false;
  for (std::int64_t reach = 0; reach < std::max(columns, rows) && !is_last; ++reach) {
    is_last = near.size() >= kNearest;
    for (std::int64_t r = std::max<std::int64_t>(0, row - reach); r <= std::min(rows - 1, row + reach); ++r) {
      if (std::abs(r - row) < reach) {
        add_box(column - reach, r);
        add_box(column + reach, r);
        continue;
      }
      const std::int64_t last = std::min(columns - 1, column + reach);
      for (std::int64_t c = std::max<std::int64_t>(0, column - reach); c <= last; ++c) add_box(c, r);
    }
  }
  const auto is_nearer = [](const Near& a, const Near& b) { return a.square < b.square; };
  const std::size_t count = std::min(near.size(), kNearest);
  std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(count), is_nearer);
  near.resize(count);
}

std::optional<LocalPlanes::Plane> LocalPlanes::about(std::size_t part, const Vec3& at) const {
  const Shown& shown = shown_[part];
  if (shown.values.empty()) return std::nullopt;
  const Vec3 from = kernel::difference(at, shown.origin);
  near_.clear();
  find_near(shown, kernel::dot(from, shown.along_u), kernel::dot(from, shown.along_v), near_);
  const double added = kAtPlace * near_.back().square;
  if (!(added > 0.0)) return Plane{near_.back().value, {}};
  double sum = 0.0, u = 0.0, v = 0.0, f = 0.0;  // means
  for (const Near& value : near_) {
    const double weight = 1.0 / (value.square + added);
    sum += weight;
    u += weight * value.u;
    v += weight * value.v;
    f += weight * value.value;
  }
  u /= sum;
  v /= sum;
  f /= sum;
  if (near_.size() < kFewestOfPlane) return Plane{f, {}};
  double uu = 0.0, uv = 0.0, vv = 0.0, uf = 0.0, vf = 0.0;
  for (const Near& value : near_) {
    const double weight = 1.0 / (value.square + added), du = value.u - u, dv = value.v - v, df = value.value - f;
    uu += weight * du * du;
    uv += weight * du * dv;
    vv += weight * dv * dv;
    uf += weight * du * df;
    vf += weight * dv * df;
  }
  const auto plane = [&](double along_u, double along_v) {
    return Plane{f - along_u * u - along_v * v,
                 kernel::sum(kernel::scaled(shown.along_u, along_u), kernel::scaled(shown.along_v, along_v))};
  };
  const double determinant = uu * vv - uv * uv;
  if (determinant > kThin * (uu + vv) * (uu + vv)) {
    return plane((vv * uf - uv * vf) / determinant, (uu * vf - uv * uf) / determinant);
  }
  // Nearly along a line, of which alone they tell something.
  const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv), c = std::cos(angle), d = std::sin(angle);
  const double along = (c * uf + d * vf) / (c * c * uu + 2.0 * c * d * uv + d * d * vv);
  return std::isfinite(along) ? plane(along * c, along * d) : Plane{f, {}};
}

// --- Interim analyses ---

namespace {

constexpr std::size_t kPointsOfStratum = kDraws;
static_assert(kPointsOfFirstAnalysis >= kPointsOfStratum * kFewestStrata);
constexpr double kNarrower = 0.1;  // than the analysis before: what is asked for is mostly a power of ten. With 0.2,
                                   // the runs above take 2.9 and 1.4 times as many points, with 0.05 9.4 and 2.7 times
constexpr double kOfDraws = 0x1p-31;  // the mean of a control variate is that at the middle of its tile, within less

constexpr double kFarthestShare = 2.0 / 3.0;  // of a side, from the middle of a tile to its corners, at most

constexpr std::size_t kPointsOfSplit = 2 * kPointsOfStratum;  // more after a split than before, at most

double share_of(double risk, std::size_t analysis) { return risk / static_cast<double>(analysis * (analysis + 1)); }

// From one stratum; that from several is as many times smaller.
double width_of_one(double range, double risk) {
  return 2.0 * StratifiedMean().error(range / kDraws, share_of(risk, 1));
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

InterimAnalyses::InterimAnalyses(SampledFunction& function, const Units& units, double risk, std::size_t before,
                                 std::size_t first)
    : function_(function),
      units_(units),
      risk_(risk),
      of_shares_(error_of_shares(function.parts(), units)),
      strata_(function.parts(), first / kPointsOfStratum, [this](const Tile& tile) { return function_.range(tile); }),
      planes_(function.parts()),
      number_(before) {}

std::size_t InterimAnalyses::points_of_next() const { return kPointsOfStratum * strata_.strata().strata.size(); }

double InterimAnalyses::risk_of(std::size_t analysis) const { return share_of(risk_, analysis); }

// False if all points might then be more, or the strata are too small.
bool InterimAnalyses::split_within(std::size_t points) {
  kernel::poll();
  if (points_after_next() + kPointsOfSplit > points) return false;
  return strata_.split_largest_term();
}

bool InterimAnalyses::prepare(double width, std::uint64_t effort, std::size_t points) {
  // More points rarely help where the function is not known.
  if (!(width > last_.most.value - last_.least.value)) return false;
  while (expected_width() > width) {
    if (effort_after_next() > effort || !split_within(points)) return false;
  }
  return effort_after_next() <= effort && points_after_next() <= points;
}

bool InterimAnalyses::prepare_for_all(std::size_t points) {
  while (split_within(points)) {
  }
  return points_after_next() <= points;
}

// Of the next analysis, from what is proved of the function and from the last analysis.
double InterimAnalyses::expected_width() const {
  const double square = strata_.sum_of_squares();
  const double error =
      StratifiedMean{.expected = square, .square = square}.error(strata_.largest_term(), risk_of(number_ + 1));
  return std::min(1.0, last_.most.value + error) - std::max(0.0, last_.least.value - error);
}

InterimAnalyses::Mean InterimAnalyses::analyse() {
  Last next;
  next.strata = strata_.strata().strata.size();
  next.least.expected = next.most.expected = strata_.sum_of_squares();
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

// A linear function on a tile, by shares of its sides.
struct InterimAnalyses::ControlVariate {
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

InterimAnalyses::ControlVariate InterimAnalyses::control_on(const Tile& tile) const {
  ControlVariate control{.value = last_number_, .middle = middle_of(tile), .slope = {}};
  const Sides sides = sides_of(function_.parts()[tile.part], tile);
  const std::optional<LocalPlanes::Plane> plane = planes_.about(tile.part, sides.at(control.middle));
  if (!plane || !std::isfinite(plane->value)) return control;
  control.value = plane->value;
  control.slope = {kernel::dot(plane->gradient, sides.along), kernel::dot(plane->gradient, sides.up)};
  return control;
}

std::optional<double> InterimAnalyses::number_at(const Tile& tile, const Place& place) {
  const Point point = point_at(function_.parts()[tile.part], tile, place, units_);
  const std::optional<double> number = function_.at(point, tile.part);
  if (number) {
    planes_.add(tile.part, point.at, *number);
    last_number_ = *number;
  }
  return number;
}

// Control variates lie within the range. Where a stratum has several tiles, they are the same on all of these. Numbers
// are rounded, and clamped to what is proved.
void InterimAnalyses::add(std::size_t stratum, Last& analysis) {
  const Strata& strata = strata_.strata();
  const Stratum& whole = strata.strata[stratum];
  const double range = strata_.range(stratum), share = whole.area / strata.area / kDraws;
  const double before = analysis.most.square;
  const bool is_single = whole.end == whole.begin + 1;
  for (std::size_t d = 0; d < kDraws; ++d) {
    Draws draws(number_, stratum, d);
    const Tile& tile = draw_tile(strata, whole, d, draws);
    ControlVariate control = is_single ? control_on(tile) : ControlVariate{last_number_, {}, {}};
    control.value = std::clamp(control.value, 0.0, range);
    control.flatten(std::min(control.value, range - control.value));
    const Place place = draw_place(tile, draws);
    const std::optional<double> number = number_at(tile, place);
    analysis.least.add(std::clamp(number.value_or(0.0), 0.0, range), control.at(place), control.value, share);
    analysis.most.add(std::clamp(number.value_or(range), 0.0, range), control.at(place), control.value, share);
  }
  strata_.set_square(stratum, analysis.most.square - before);
}

}  // namespace exactff::view_factors
