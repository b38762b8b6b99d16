// Closed surfaces, told apart where they touch.
//
// At every edge, faces are paired across the wedge behind them: from a face, one turns round the edge, on the side of
// its back, to the face that ends the wedge. So two boxes that share edges are two solids, and so are a room and the
// box in its corner. An edge that only two pieces have, in no part of which there is another, pairs these; pieces that
// such edges connect are paired first at the others, since behind the walls of two rooms that touch, wedges overlap. A
// solid is a set of pieces that pairs connect, with every edge of each of them paired. Edges are matched by the
// positions of their ends, and cut at T-junctions. Transparent pieces, and twins of faces (Face::is_twin), belong to no
// solid.
//
// Where faces lie on each other with the same front, which of them belongs to a solid depends on their order and on how
// they are cut.
//
// A solid of positive volume has its fronts outside, as a box has. One of negative volume has them inside, as a room
// has. That of a sheet with two faces has no volume.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"
#include "scene/shaft_tree.h"

namespace exactff {

// Whether they have a point in common.
[[nodiscard]] inline bool meet(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

struct Solid {
  Box box;
  int sign = 0;  // of its volume, exact
  std::vector<std::uint32_t> pieces;
};

class Solids {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  explicit Solids(const Scene& scene);

  [[nodiscard]] std::span<const Solid> all() const { return solids_; }
  // The index of a piece's solid, or kNone.
  [[nodiscard]] std::uint32_t of_piece(std::uint32_t piece) const { return of_piece_[piece]; }

 private:
  std::vector<Solid> solids_;
  std::vector<std::uint32_t> of_piece_;
};

// --- Junctions ---

// Directed edges of pieces, and T-junctions: edges that other pieces have in parts.

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
