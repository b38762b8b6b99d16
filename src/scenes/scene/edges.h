// The edges of a scene's pieces, joined where their ends have the same positions, and a tree that finds those that may
// lie in a shaft and may be silhouettes.
//
// A piece uses an edge upwards or downwards: from the end with the lower place to the other, or back, as its corners
// run seen from its front. Transparent pieces use none.
//
// An edge is *smooth* from x if as many of its pieces lie on one side of it as on the other, seen from x. Each piece
// may be turned over on paper so that neighbours agree where that is possible. If then as many pieces use an edge
// upwards as downwards, it is *balanced*, and it is smooth from every x that sees the same side of all its pieces: a
// piece whose front x sees lies on the left of an edge that it uses upwards, and on the right of one that it uses
// downwards.
//
// A node of the tree knows a box that holds its edges' pieces, and, if all its edges are balanced, bounds of the
// pieces' normals (a spatialised normal cone: Johnson and Cohen 2001; Sander et al. 2000; here with a box instead of a
// cone). If these prove that x sees the same side of all pieces, the node holds smooth edges alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "scene/shaft_tree.h"

namespace exactff {

struct SceneEdge {
  std::uint32_t a = 0, b = 0;  // places, a < b
  std::uint32_t first_use = 0;
};

struct EdgeUse {
  EdgeUse(std::uint32_t of, bool up) : piece_and_way(2 * of + (up ? 1U : 0U)) {}
  [[nodiscard]] std::uint32_t piece() const { return piece_and_way / 2; }
  [[nodiscard]] bool upwards() const { return piece_and_way % 2 != 0; }
  std::uint32_t piece_and_way;
};

class SceneEdges {
 public:
  SceneEdges() = default;
  explicit SceneEdges(const Scene& scene);

  [[nodiscard]] std::size_t size() const { return edges_.empty() ? 0 : edges_.size() - 1; }
  [[nodiscard]] const SceneEdge& edge(std::uint32_t id) const { return edges_[id]; }
  [[nodiscard]] std::span<const EdgeUse> uses(std::uint32_t id) const {
    return {uses_.data() + edges_[id].first_use, uses_.data() + edges_[id + 1].first_use};
  }
  // The edges of a piece, in the order of its corners. Requires a piece that is not transparent.
  [[nodiscard]] std::span<const std::uint32_t> of_piece(const Piece& piece) const;

  // Calls visit(edge, in_front) for every edge that may have a part in the shaft, except for some that are certainly
  // smooth from the apex. The first group of half-spaces decides what is in front: `in_front` means that all pieces of
  // the edge lie certainly inside it, and only such edges are left out.
  template <class Visit>
  void query(const Vec3& apex, const HalfSpaceGroups& shaft, const Visit& visit) const {
    if (nodes_.empty()) return;
    struct Waiting {
      std::uint32_t node;
      std::uint64_t crossed;
    };
    Waiting stack[kDepthLimit];
    int size = 0;
    stack[size++] = {0, ShaftTree::kAllGroups};
    while (size > 0) {
      const Waiting at = stack[--size];
      const Node& node = nodes_[at.node];
      std::uint64_t crossed = at.crossed;
      if (const std::uint64_t front = crossed & 1U; front != 0) {
        const std::uint64_t still = ShaftTree::crossed_groups(node.box, apex, shaft.groups().first(1), front);
        if (still == ShaftTree::kOutside) continue;
        crossed = (crossed & ~front) | still;
      }
      const bool in_front = (crossed & 1U) == 0;
      if (in_front && node.sees_one_side(apex)) continue;
      if ((crossed & ~1U) != 0) {
        const std::uint64_t still =
            ShaftTree::crossed_groups(node.box, apex, shaft.groups(), crossed & ~std::uint64_t{1});
        if (still == ShaftTree::kOutside) continue;
        crossed = (crossed & 1U) | still;
      }
      if (node.right != 0) {
        fetch(nodes_[node.right]);  // its turn comes after the whole left part
        stack[size++] = {node.right, crossed};
        stack[size++] = {at.node + 1, crossed};
      } else {
        for (std::uint32_t edge = node.first; edge < node.last; ++edge) visit(edge, in_front);
      }
    }
  }

 private:
  friend class SceneEdgesBuilder;
  static constexpr int kDepthLimit = 64;  // the tree is balanced: depth <= 32 for any 32-bit count

  struct Node {  // the left child follows its parent
    Box box;
    std::array<float, 3> least_normal, largest_normal;  // NaN where an edge is not balanced
    std::uint32_t right = 0;                            // of a leaf: 0
    std::uint32_t first = 0, last = 0;                  // edges
    // Whether x certainly sees the fronts of all pieces, or the backs of all.
    [[nodiscard]] bool sees_one_side(const Vec3& x) const;
  };

  // Asks for the memory of a node, which spans two cache lines, before it is needed.
  static void fetch(const Node& node) {
    __builtin_prefetch(&node.box);
    __builtin_prefetch(&node.last);
  }

  std::vector<SceneEdge> edges_;  // one more at the end
  std::vector<EdgeUse> uses_;
  std::vector<std::uint32_t> edge_of_corner_;  // for every corner of every piece, the edge that begins there
  std::vector<Node> nodes_;
};

// The edges of the scene, found at the first call; safe to call from several threads.
const SceneEdges& scene_edges(const Scene& scene);

// --- Connectedness ---

// How far the pieces of a scene are connected, and what a search for silhouettes may therefore save.

// About how many edges there are for each that is a silhouette from a typical point. Of a soup of faces 1, of a box
// less than 3, of a mesh of n triangles about sqrt(n) / 3. Found at the first call, in about linear time; safe to call
// from several threads.
[[nodiscard]] double edges_per_silhouette(const Scene& scene);

}  // namespace exactff
