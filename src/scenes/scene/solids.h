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

#include <cstdint>
#include <span>
#include <vector>

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

}  // namespace exactff
