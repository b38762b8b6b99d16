#include "view_factors/split_strata.h"

#include <algorithm>
#include <utility>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

constexpr double kOfSplit = 0.7;                 // of a square: a half differs less from its guess
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

bool SplitStrata::Known::is_by_middle() const { return kOverChange * span.change < span.range / kDraws; }
double SplitStrata::Known::term() const { return std::min(kOverChange * span.change, span.range / kDraws); }

SplitStrata::SplitStrata(const std::vector<Part>& parts, std::size_t count, SpanOf span)
    : parts_(parts), span_(std::move(span)), strata_(strata_of(parts, count)) {
  const std::vector<Stratum> first = std::exchange(strata_.strata, {});
  for (std::size_t s = 0; s < first.size(); ++s) put(s, first[s], {});
}

Span SplitStrata::span_of(const Stratum& stratum) const {
  const bool is_alone = stratum.end == stratum.begin + 1;
  Span span = span_(strata_.tiles[stratum.begin], is_alone);
  for (std::size_t t = stratum.begin + 1; t < stratum.end; ++t) {
    span.range = std::max(span.range, span_(strata_.tiles[t], false).range);
  }
  if (!is_alone) span.change = HUGE_VAL;
  return span;
}

bool SplitStrata::is_less_urgent(const Waiting& a, const Waiting& b) {
  return a.size != b.size ? a.size < b.size : a.stratum > b.stratum;
}

void SplitStrata::push(Heap& heap, double size, std::size_t stratum) {
  heap.push_back({size, stratum, known_[stratum].version});
  std::ranges::push_heap(heap, is_less_urgent);
  drop_old(heap);
}

void SplitStrata::drop_old(Heap& heap) const {
  while (!heap.empty() && heap.front().version != known_[heap.front().stratum].version) {
    std::ranges::pop_heap(heap, is_less_urgent);
    heap.pop_back();
  }
}

void SplitStrata::set_square(std::size_t stratum, double square) {
  Known& known = known_[stratum];
  sum_of_squares_ += square - known.square;
  known.square = square;
  ++known.version;
  push(by_term_, share(stratum) * known.term(), stratum);
  push(by_square_, square, stratum);
}

// At a place that is free, or at the end.
void SplitStrata::put(std::size_t place, const Stratum& stratum, const Known& of_whole) {
  if (place == strata_.strata.size()) {
    strata_.strata.emplace_back();
    known_.emplace_back();
  }
  strata_.strata[place] = stratum;
  Known& known = known_[place];
  known.span = span_of(stratum);
  known.span.range = std::min(of_whole.span.range, known.span.range);
  known.square = of_whole.square;
  ++known.version;
  sum_of_squares_ += known.square;
  push(by_term_, share(place) * known.term(), place);
  if (known.square > 0.0) push(by_square_, known.square, place);
}

bool SplitStrata::split(Heap& heap) {
  if (heap.empty()) return false;
  const std::size_t place = heap.front().stratum;
  const Stratum whole = strata_.strata[place];
  const bool is_single = whole.end == whole.begin + 1;
  const Tile tile = strata_.tiles[whole.begin];
  if (is_single && std::max(tile.columns, tile.rows) > kMostColumns / 2) return false;
  const Known known = known_[place];
  sum_of_squares_ = std::max(0.0, sum_of_squares_ - known.square);
  is_single ? cut(tile, known, place) : share_out(whole, known, place);
  drop_old(by_term_);
  drop_old(by_square_);
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
  return {.span = known.span, .square = kOfSplit * share * share * known.square};
}

}  // namespace exactff::view_factors
