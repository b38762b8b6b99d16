// Directed edges of pieces, and T-junctions: edges that other pieces have in parts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "exactff/geometry.h"

namespace exactff {

struct EdgeOfPiece {
  std::uint32_t low = 0, high = 0;  // places
  std::uint32_t piece = 0;
  bool upwards = false;  // from `low` to `high`

  [[nodiscard]] bool joins_what(const EdgeOfPiece& other) const { return low == other.low && high == other.high; }
};

inline bool comes_before(const EdgeOfPiece& a, const EdgeOfPiece& b) {
  return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.piece < b.piece;
}

// Calls take(first, last) for every run of uses of one edge. Sorts them.
template <class Take>
void for_each_edge(std::vector<EdgeOfPiece>& uses, const Take& take) {
  std::sort(uses.begin(), uses.end(), comes_before);
  for (auto first = uses.begin(); first != uses.end();) {
    const auto last = std::find_if(first, uses.end(), [&](const EdgeOfPiece& use) { return !use.joins_what(*first); });
    take(first, last);
    first = last;
  }
}

// The uses upwards less those downwards.
template <class Iterator>
std::ptrdiff_t balance_of(Iterator first, Iterator last) {
  const std::ptrdiff_t up = std::count_if(first, last, [](const EdgeOfPiece& use) { return use.upwards; });
  return 2 * up - (last - first);
}

// Whether the middle point lies on the line through the others, which differ from it. Exact.
[[nodiscard]] bool are_straight(const Vec3& a, const Vec3& middle, const Vec3& c);

// Cuts edges where ends of others lie inside them. Of more than this many edges none is cut: where all of them have
// about the same x, the time is quadratic.
inline constexpr std::size_t kMostCut = 2048;
void cut_at_junctions(std::vector<EdgeOfPiece>& edges, std::span<const Vec3> vertices);

}  // namespace exactff
