#include "view_factors/split_strata.h"

#include <algorithm>
#include <utility>

#include "kernel/vec.h"

namespace exactff::view_factors {
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
  for (std::size_t s = 0; s < first.size(); ++s) put(s, first[s], {1.0, 0.0});
}

double SplitStrata::range_of(const Stratum& stratum) const {
  double range = 0.0;
  for (std::size_t t = stratum.begin; t < stratum.end; ++t) range = std::max(range, range_(strata_.tiles[t]));
  return range;
}

bool SplitStrata::is_less_urgent(std::size_t a, std::size_t b) const {
  return weight(a) != weight(b) ? weight(a) < weight(b) : a > b;
}

// At a place that is free, or at the end.
void SplitStrata::put(std::size_t place, const Stratum& stratum, const Known& of_whole) {
  if (place == strata_.strata.size()) {
    strata_.strata.emplace_back();
    ranges_.emplace_back();
    guesses_.emplace_back();
  }
  strata_.strata[place] = stratum;
  ranges_[place] = std::min(of_whole.range, range_of(stratum));
  guesses_[place] = of_whole.guess;
  heap_.push_back(place);
  std::ranges::push_heap(heap_, [this](std::size_t a, std::size_t b) { return is_less_urgent(a, b); });
}

bool SplitStrata::split() {
  const std::size_t place = heap_.front();
  const Stratum whole = strata_.strata[place];
  const bool is_single = whole.end == whole.begin + 1;
  const Tile tile = strata_.tiles[whole.begin];
  if (is_single && std::max(tile.columns, tile.rows) > kMostColumns / 2) return false;
  std::ranges::pop_heap(heap_, [this](std::size_t a, std::size_t b) { return is_less_urgent(a, b); });
  heap_.pop_back();
  const Known known{ranges_[place], guesses_[place]};
  is_single ? cut(tile, known, place) : share_out(whole, known, place);
  return true;
}

// Its tiles, to two strata of about the same area.
void SplitStrata::share_out(const Stratum& whole, const Known& of_whole, std::size_t place) {
  Stratum first{whole.begin, whole.begin + 1, strata_.tiles[whole.begin].area};
  while (first.end + 1 < whole.end && first.area + strata_.tiles[first.end].area <= 0.5 * whole.area) {
    first.area += strata_.tiles[first.end++].area;
  }
  Stratum second{first.end, whole.end, 0.0};
  for (std::size_t t = second.begin; t < second.end; ++t) second.area += strata_.tiles[t].area;
  put(place, first, of_whole);
  put(strata_.strata.size(), second, of_whole);
}

void SplitStrata::cut(const Tile& tile, const Known& of_whole, std::size_t place) {
  const bool is_triangle = tile.shape == Tile::Shape::kTriangle;
  for (const Tile& piece : is_triangle ? thirds_of(tile) : halves_of(tile, parts_[tile.part])) {
    const std::size_t at = strata_.tiles.size();
    strata_.tiles.push_back(piece);
    put(place, {at, at + 1, piece.area}, of_whole);
    place = strata_.strata.size();
  }
}

}  // namespace exactff::view_factors
