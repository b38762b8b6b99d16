#include "slips/oriented_surfaces.h"

#include <algorithm>
#include <numeric>

#include "scene/scene.h"
#include "scene/solids.h"

namespace exactff::slips {

namespace {

class Joiner {
 public:
  explicit Joiner(const Scene& scene) : scene_(scene), parent_(scene.pieces().size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    for (std::uint32_t p = 1; p < parent_.size(); ++p) {
      if (scene.pieces()[p].face == scene.pieces()[p - 1].face) parent_[p] = parent_[p - 1];
    }
  }

  void join() {
    std::vector<EdgeOfPiece> edges = edges_of_pieces(), others;
    join_at(edges, [&](auto first, auto last) { others.insert(others.end(), first, last); });
    cut_at_junctions(others, scene_.vertices());
    join_at(others, [](auto, auto) {});
  }

  std::uint32_t root(std::uint32_t piece) {
    while (parent_[piece] != piece) piece = parent_[piece] = parent_[parent_[piece]];
    return piece;
  }

 private:
  [[nodiscard]] std::vector<EdgeOfPiece> edges_of_pieces() const {
    std::vector<EdgeOfPiece> edges;
    for (std::uint32_t piece = 0; piece < parent_.size(); ++piece) {
      const auto corners = scene_.corners(scene_.pieces()[piece]);
      std::uint32_t from = places(scene_)[corners.back()];
      for (const std::uint32_t corner : corners) {
        const std::uint32_t to = places(scene_)[corner];
        edges.push_back({std::min(from, to), std::max(from, to), piece, from < to});
        from = to;
      }
    }
    return edges;
  }

  template <class TakeOthers>
  void join_at(std::vector<EdgeOfPiece>& edges, const TakeOthers& take_others) {
    for_each_edge(edges, [&](auto first, auto last) {
      if (last - first != 2 || balance_of(first, last) != 0) return take_others(first, last);
      parent_[root(first->piece)] = root((first + 1)->piece);
    });
  }

  const Scene& scene_;
  std::vector<std::uint32_t> parent_;  // by piece
};

}  // namespace

std::vector<std::uint32_t> oriented_surfaces(const Scene& scene) {
  Joiner joiner(scene);
  joiner.join();
  constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::vector<std::uint32_t> number(scene.pieces().size(), kNone), of_piece;
  std::uint32_t count = 0;
  for (std::uint32_t piece = 0; piece < number.size(); ++piece) {
    std::uint32_t& one = number[joiner.root(piece)];
    if (one == kNone) one = count++;
    of_piece.push_back(one);
  }
  return of_piece;
}

}  // namespace exactff::slips
