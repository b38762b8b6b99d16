// A bounding-volume tree over the pieces of a scene, asked for what may lie in a shaft.
//
// Boxes are exact (their sides are coordinates of the scene). A query drops a box only if it is proved to lie
// outside one half-space of the shaft; what it returns is a superset of the pieces that meet the shaft.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/geometry.h"

namespace exactff {

// The points y with normal . (y - apex) >= offset. Each component of the normal, and the offset, within relative
// error 2^-52 of an exact value, zero exactly where that is zero. NaN anywhere: the half-space drops nothing.
struct HalfSpace {
  Vec3 normal;
  double offset = 0.0;
  double error = 0.0;  // of each component of the normal, beyond the relative one
};

struct Box {
  Vec3 low;
  Vec3 high;
};

class ShaftTree {
 public:
  ShaftTree() = default;
  explicit ShaftTree(std::span<const Box> boxes);

  // Calls visit(index) for every box not certainly outside, in a fixed order, until one call returns false.
  template <class Visit>
  void query(const Vec3& apex, std::span<const HalfSpace> shaft, Visit&& visit) const {
    if (nodes_.empty()) return;
    Waiting stack[kDepthLimit];
    int size = 0;
    stack[size++] = {0, kAllHalfSpaces};
    while (size > 0) {
      const Waiting at = stack[--size];
      const Node& node = nodes_[at.node];
      const std::uint64_t crossed = crossed_half_spaces(node.box, apex, shaft, at.crossed);
      if (crossed == kOutside) continue;
      if (node.count == 0) {
        stack[size++] = {node.right, crossed};
        stack[size++] = {static_cast<std::uint32_t>(&node - nodes_.data()) + 1, crossed};
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (node.count > 1 && crossed_half_spaces(boxes_[i], apex, shaft, crossed) == kOutside) continue;
        if (!visit(order_[i])) return;
      }
    }
  }

  static bool certainly_outside(const Box& box, const Vec3& apex, std::span<const HalfSpace> shaft);

 private:
  static constexpr int kDepthLimit = 64;  // the tree is balanced: depth <= 32 for any 32-bit count
  static constexpr std::uint32_t kLeafSize = 4;

  // A set of half-spaces as bits; those beyond the 62nd are always in it.
  static constexpr std::uint64_t kAllHalfSpaces = (std::uint64_t{1} << 62U) - 1;
  static constexpr std::uint64_t kOutside = std::uint64_t{1} << 63U;
  struct Waiting {
    std::uint32_t node;
    std::uint64_t crossed;
  };

  struct Node {  // the left child follows its parent
    Box box;
    std::uint32_t right = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0 for an inner node
  };

  void build(std::span<const Box> boxes, std::uint32_t first, std::uint32_t last);
  // Of the half-spaces asked for, those that may cut the box: what lies inside need not be asked again further down.
  // kOutside if the box lies certainly outside one of them.
  static std::uint64_t crossed_half_spaces(const Box& box, const Vec3& apex, std::span<const HalfSpace> shaft,
                                           std::uint64_t asked);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;  // in the order of order_
};

class Scene;

// The tree over the scene's pieces, built when first asked for; safe to call from several threads.
const ShaftTree& shaft_tree(const Scene& scene);

}  // namespace exactff
