#include "view_factors/strata.h"

#include <algorithm>
#include <utility>

#include "kernel/numbers.h"
#include "kernel/split_mix.h"

namespace exactff::view_factors {
namespace {

constexpr int kShareBits = 32;
constexpr std::uint64_t kWholeSide = std::uint64_t{1} << kShareBits;

std::uint64_t mix(std::uint64_t key) { return kernel::split_mix(0, key); }

constexpr double kAreaRoundings = 0x1p-40;  // relative: far more than there are

// Exactly.
bool is_parallelogram(const Part& part) {
  if (part.corners.size() != 4) return false;
  const auto at = [&](std::size_t i) -> const Homogeneous& { return part.corners[i].exact; };
  const Integer even = at(0)[3] * at(2)[3], odd = at(1)[3] * at(3)[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const Integer one = (at(0)[k] * at(2)[3] + at(2)[k] * at(0)[3]) * odd;
    const Integer other = (at(1)[k] * at(3)[3] + at(3)[k] * at(1)[3]) * even;
    if (one != other) return false;
  }
  return true;
}

// Into tiles of about equal sides, none of them larger than `largest`.
void cut_parallelogram(std::size_t part, const std::vector<Vec3>& ring, double size, double largest,
                       std::vector<Tile>& into) {
  const auto length = [&](std::size_t corner) { return kernel::length(kernel::difference(ring[corner], ring[0])); };
  const double tiles = std::ceil(size / largest * (1.0 - kAreaRoundings));
  // Rounded along the shorter side, so that the other number, rounded up, adds few.
  const double ratio = length(1) / length(3);
  const auto rounded_root = [&](double square) { return std::clamp(std::round(std::sqrt(square)), 1.0, tiles); };
  const double columns = ratio < 1.0 ? rounded_root(tiles * ratio) : std::ceil(tiles / rounded_root(tiles / ratio));
  const double rows = std::ceil(tiles / columns);
  const auto m = static_cast<std::uint32_t>(columns), n = static_cast<std::uint32_t>(rows);
  for (std::uint32_t u = 0; u < m; ++u) {
    for (std::uint32_t v = 0; v < n; ++v) {
      into.push_back({part, 1, 3, m, n, u, v, Tile::Shape::kParallelogram, size / (columns * rows)});
    }
  }
}

void cut_triangle(std::size_t part, std::size_t second, double size, double largest, std::vector<Tile>& into) {
  const double sides = std::ceil(std::sqrt(2.0 * size / largest * (1.0 - kAreaRoundings)));
  const double parallelogram = 2.0 * size / (sides * sides);
  const auto m = static_cast<std::uint32_t>(sides);
  for (std::uint32_t u = 0; u < m; ++u) {
    for (std::uint32_t v = 0; u + v + 1 < m; ++v) {
      into.push_back({part, second, second + 1, m, m, u, v, Tile::Shape::kParallelogram, parallelogram});
    }
    into.push_back({part, second, second + 1, m, m, u, m - 1 - u, Tile::Shape::kTriangle, 0.5 * parallelogram});
  }
}

}  // namespace

Draws::Draws(std::size_t analysis, std::size_t stratum, std::size_t number)
    : key_(mix(mix(analysis) ^ mix(stratum) << 1 ^ number)) {}
std::uint64_t Draws::bits() { return mix(key_ ^ ++count_ << 32); }
double Draws::unit() { return kernel::unit_fraction(bits()); }

Strata strata_of(const std::vector<Part>& parts, std::size_t count) {
  Strata result;
  double total = 0.0;
  for (const Part& part : parts) total += part.weight * area(positions_of(part.corners));
  const double largest = total / static_cast<double>(count);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<Vec3> ring = positions_of(parts[p].corners);
    const double whole = parts[p].weight * area(ring);
    if (whole > 0.0 && is_parallelogram(parts[p])) {
      cut_parallelogram(p, ring, whole, largest, result.tiles);
      continue;
    }
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const double size = parts[p].weight * area({ring[0], ring[i], ring[i + 1]});
      if (size > 0.0) cut_triangle(p, i, size, largest, result.tiles);
    }
  }
  const bool whole_ones_share = result.tiles.size() > 2 * count, all_share = result.tiles.size() > 4 * count;
  const auto shares = [&](const Tile& tile) { return parts[tile.part].is_cut ? all_share : whole_ones_share; };
  for (std::size_t i = 0; i < result.tiles.size(); ++i) {
    const double size = result.tiles[i].area;
    const bool joins =
        i > 0 && result.strata.back().area + size <= largest && shares(result.tiles[i - 1]) && shares(result.tiles[i]);
    if (!joins) result.strata.push_back({i, i, 0.0});
    result.strata.back().end = i + 1;
    result.strata.back().area += size;
  }
  for (const Stratum& stratum : result.strata) result.area += stratum.area;
  return result;
}

const Tile& draw_tile(const Strata& strata, const Stratum& stratum, std::size_t draw, Draws& draws) {
  std::size_t i = stratum.begin;
  for (double left = 0.5 * (static_cast<double>(draw) + draws.unit()) * stratum.area;
       i + 1 < stratum.end && left >= strata.tiles[i].area; ++i) {
    left -= strata.tiles[i].area;
  }
  return strata.tiles[i];
}

Place middle_of(const Tile& tile) {
  const double share = tile.shape == Tile::Shape::kTriangle ? 1.0 / 3.0 : 0.5;
  return {share, share};
}

Place draw_place(const Tile& tile, Draws& draws) {
  std::uint64_t along = draws.bits() >> (64 - kShareBits), up = draws.bits() >> (64 - kShareBits);
  if (tile.shape == Tile::Shape::kTriangle && along + up > kWholeSide) {
    along = kWholeSide - along;
    up = kWholeSide - up;
  }
  return {std::ldexp(static_cast<double>(along), -kShareBits), std::ldexp(static_cast<double>(up), -kShareBits)};
}

Point point_at(const Part& part, const Tile& tile, const Place& place, const Units& units) {
  const auto share = [](double x) { return static_cast<std::uint64_t>(std::ldexp(x, kShareBits)); };
  const Integer whole = (Integer(tile.columns) * Integer(tile.rows)) << kShareBits;
  const Integer s = Integer(tile.column * kWholeSide + share(place.along)) * Integer(tile.rows);
  const Integer t = Integer(tile.row * kWholeSide + share(place.up)) * Integer(tile.columns);
  const std::array<const Point*, 3> corners{&part.corners[0], &part.corners[tile.second], &part.corners[tile.third]};
  const std::array<Integer, 3> weights{whole - s - t, s, t};
  Homogeneous sum;
  for (std::size_t i = 0; i < 3; ++i) {
    const Integer factor = weights[i] * corners[(i + 1) % 3]->exact[3] * corners[(i + 2) % 3]->exact[3];
    for (std::size_t k = 0; k < 3; ++k) sum[k] += factor * corners[i]->exact[k];
    sum[3] += factor * corners[i]->exact[3];
  }
  const auto coordinate = [&](std::size_t k) { return kernel::nearest_double(sum[k], sum[3], -units.shift); };
  const Vec3 at{coordinate(0), coordinate(1), coordinate(2)};
  return {std::move(sum), at};
}

Vec3 Sides::at(const Place& place) const {
  return kernel::along(kernel::along(origin, along, place.along), up, place.up);
}

Sides sides_of(const Part& part, const Tile& tile) {
  const Vec3& from = part.corners[0].at;
  const auto side = [&](std::size_t to, std::uint32_t count) {
    return kernel::scaled(kernel::difference(part.corners[to].at, from), 1.0 / static_cast<double>(count));
  };
  Sides sides{from, side(tile.second, tile.columns), side(tile.third, tile.rows)};
  sides.origin = sides.at({static_cast<double>(tile.column), static_cast<double>(tile.row)});
  return sides;
}

std::vector<Vec3> corners_of(const Part& part, const Tile& tile) {
  const Sides sides = sides_of(part, tile);
  if (tile.shape == Tile::Shape::kTriangle) return {sides.origin, sides.at({1, 0}), sides.at({0, 1})};
  return {sides.origin, sides.at({1, 0}), sides.at({1, 1}), sides.at({0, 1})};
}

// --- Split strata ---

namespace {

constexpr std::uint32_t kMostColumns = 1 << 20;  // of a grid that is made finer

Tile finer(Tile tile, std::uint32_t columns, std::uint32_t rows) {
  tile.columns *= columns;
  tile.rows *= rows;
  tile.column *= columns;
  tile.row *= rows;
  return tile;
}

// Across its longer sides.
std::vector<Tile> halves_of(const Tile& tile, const Part& part) {
  const auto side = [&](std::size_t corner, std::uint32_t count) {
    return kernel::distance(part.corners[0].at, part.corners[corner].at) / static_cast<double>(count);
  };
  const bool across = side(tile.second, tile.columns) >= side(tile.third, tile.rows);
  Tile half = across ? finer(tile, 2, 1) : finer(tile, 1, 2);
  half.area *= 0.5;
  std::vector<Tile> halves(2, half);
  ++(across ? halves[1].column : halves[1].row);
  return halves;
}

// Into a parallelogram and two triangles.
std::vector<Tile> thirds_of(const Tile& triangle) {
  Tile quarter = finer(triangle, 2, 2);
  quarter.area *= 0.25;
  std::vector<Tile> thirds(3, quarter);
  thirds[0].shape = Tile::Shape::kParallelogram;
  thirds[0].area *= 2.0;
  ++thirds[1].column;
  ++thirds[2].row;
  return thirds;
}

}  // namespace

SplitStrata::SplitStrata(const std::vector<Part>& parts, std::size_t count, RangeOf range)
    : parts_(parts), range_(std::move(range)), strata_(strata_of(parts, count)) {
  const std::vector<Stratum> first = std::exchange(strata_.strata, {});
  for (std::size_t s = 0; s < first.size(); ++s) put(s, first[s], {});
}

double SplitStrata::range_of(const Stratum& stratum) const {
  double range = 0.0;
  for (std::size_t t = stratum.begin; t < stratum.end; ++t) range = std::max(range, range_(strata_.tiles[t]));
  return range;
}

bool SplitStrata::is_less_urgent(const Waiting& a, const Waiting& b) {
  return a.term != b.term ? a.term < b.term : a.stratum > b.stratum;
}

void SplitStrata::set_square(std::size_t stratum, double square) {
  sum_of_squares_ += square - known_[stratum].square;
  known_[stratum].square = square;
}

// At a place that is free, or at the end.
void SplitStrata::put(std::size_t place, const Stratum& stratum, const Known& of_whole) {
  if (place == strata_.strata.size()) {
    strata_.strata.emplace_back();
    known_.emplace_back();
  }
  strata_.strata[place] = stratum;
  Known& known = known_[place];
  known.range = std::min(of_whole.range, range_of(stratum));
  known.square = of_whole.square;
  sum_of_squares_ += known.square;
  waiting_.push_back({share(place) * known.range / kDraws, place});
  std::ranges::push_heap(waiting_, is_less_urgent);
}

bool SplitStrata::split_largest_term() {
  if (waiting_.empty()) return false;
  const std::size_t place = waiting_.front().stratum;
  const Stratum whole = strata_.strata[place];
  const bool is_single = whole.end == whole.begin + 1;
  const Tile tile = strata_.tiles[whole.begin];
  if (is_single && std::max(tile.columns, tile.rows) > kMostColumns / 2) return false;
  std::ranges::pop_heap(waiting_, is_less_urgent);
  waiting_.pop_back();
  const Known known = known_[place];
  sum_of_squares_ = std::max(0.0, sum_of_squares_ - known.square);
  is_single ? cut(tile, known, place) : share_out(whole, known, place);
  return true;
}

// Its tiles, to two strata of about the same area.
void SplitStrata::share_out(const Stratum& whole, const Known& known, std::size_t place) {
  Stratum first{whole.begin, whole.begin + 1, strata_.tiles[whole.begin].area};
  while (first.end + 1 < whole.end && first.area + strata_.tiles[first.end].area <= 0.5 * whole.area) {
    first.area += strata_.tiles[first.end++].area;
  }
  Stratum second{first.end, whole.end, 0.0};
  for (std::size_t t = second.begin; t < second.end; ++t) second.area += strata_.tiles[t].area;
  put(place, first, part_of(known, first.area / whole.area));
  put(strata_.strata.size(), second, part_of(known, second.area / whole.area));
}

void SplitStrata::cut(const Tile& tile, const Known& known, std::size_t place) {
  const bool is_triangle = tile.shape == Tile::Shape::kTriangle;
  for (const Tile& piece : is_triangle ? thirds_of(tile) : halves_of(tile, parts_[tile.part])) {
    const std::size_t at = strata_.tiles.size();
    strata_.tiles.push_back(piece);
    put(place, {at, at + 1, piece.area}, part_of(known, piece.area / tile.area));
    place = strata_.strata.size();
  }
}

SplitStrata::Known SplitStrata::part_of(const Known& known, double share) {
  return {.range = known.range, .square = share * share * known.square};
}

// --- Stratified mean ---

namespace {

constexpr double kOfRoundings = 1.0 + 0x1p-40;  // far more than there are

// About the c that makes e least: c / (1 - c) + log(1 - c) = L / q, with q the square that is expected, over r^2. With
// less than a quarter, e would hardly be smaller: where Q is 0, it is within 2 % of r L for a risk of 10^-6.
double best_c(double l, double q) {
  const double ratio = l / std::max(0.25, q), odds = std::sqrt(2.0 * ratio) + ratio;
  return odds / (1.0 + odds);
}

}  // namespace

void StratifiedMean::add(double number, double control, double mean_of_control, double share) {
  const double off = share * (number - control);
  value += share * mean_of_control + off;
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
