// A bounding-volume tree over the pieces of a scene. A query finds the pieces that may lie in a shaft.
//
// Boxes are exact (their sides are coordinates of the scene). A query drops a box only if it is proved to lie outside
// one half-space of the shaft; the result is a superset of the pieces that meet the shaft.
#pragma once

#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"

namespace exactff {

// The points y with normal . (y - apex) >= offset. Each component of the normal, and the offset, within relative
// error 2^-52 of an exact value, zero exactly where that value is zero. A half-space with a NaN drops nothing.
struct HalfSpace {
  Vec3 normal;
  double offset = 0.0;
  double error = 0.0;  // of each component of the normal, beyond the relative one
  double blur = 0.0;   // the offset may be too small by this much, beyond the relative error
};

struct Box {
  Vec3 low;
  Vec3 high;

  void include(const Vec3& v) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
};

[[nodiscard]] int longest_axis(const Box& box);

// Half-spaces in groups of four, for vector registers. A missing one is replaced by a half-space that contains
// everything.
class HalfSpaceGroups {
 public:
  static constexpr std::size_t kLanes = 4;
  using Lanes = std::array<double, kLanes>;
  struct Group {
    Lanes x, y, z, offset, error, blur;
  };

  HalfSpaceGroups() = default;
  explicit HalfSpaceGroups(std::span<const HalfSpace> half_spaces) { set(half_spaces); }
  // Replaces the half-spaces. Reuses the memory.
  void set(std::span<const HalfSpace> half_spaces);
  [[nodiscard]] std::span<const Group> groups() const { return {groups_.data(), groups_.size()}; }

 private:
  boost::container::small_vector<Group, 3> groups_;
};

// The points from + t along, t >= 0, prepared for tests against boxes.
class RaySlabs {
 public:
  RaySlabs(const Vec3& from, const Vec3& along);

  // Not above the smallest t at which the ray meets the box; kMissed if it certainly meets it nowhere.
  static constexpr double kMissed = std::numeric_limits<double>::infinity();
  [[nodiscard]] double entry(const Box& box) const;

 private:
  struct Axis {
    double from = 0.0;
    double inverse = 0.0;  // 1 / along; 0: see `fixed`
    bool fixed = false;    // along is 0: the coordinate does not change
  };
  std::array<Axis, 3> axes_;
};

class ShaftTree {
 public:
  ShaftTree() = default;
  // Boxes are known by their indices, or by these ids.
  explicit ShaftTree(std::span<const Box> boxes, std::span<const std::uint32_t> ids = {});

  // Calls visit(index) for every box not certainly outside, in a fixed order, until one call returns false.
  template <class Visit>
  void query(const Vec3& apex, std::span<const HalfSpace> shaft, const Visit& visit) const {
    query_with_inside(apex, HalfSpaceGroups(shaft), [&](std::uint32_t index, bool) { return visit(index); });
  }

  // The same, but calls visit(index, inside). `inside`: the box lies certainly inside every half-space, off its plane.
  template <class Visit>
  void query_with_inside(const Vec3& apex, const HalfSpaceGroups& half_spaces, const Visit& visit) const {
    if (nodes_.empty()) return;
    const auto shaft = half_spaces.groups();
    const bool may_be_inside = shaft.size() <= kGroupBits;
    Waiting stack[kDepthLimit];
    int size = 0;
    stack[size++] = {0, kAllGroups};
    while (size > 0) {
      const Waiting at = stack[--size];
      const Node& node = nodes_[at.node];
      const std::uint64_t crossed = crossed_groups(node.box, apex, shaft, at.crossed);
      if (crossed == kOutside) continue;
      const std::uint32_t end = node.first + node.count;
      if (crossed == 0 && may_be_inside) {
        for (std::uint32_t i = node.first; i < end; ++i) {
          if (!visit(order_[i], true)) return;
        }
      } else if (node.count > kLeafSize) {
        stack[size++] = {node.right, crossed};
        stack[size++] = {at.node + 1, crossed};
      } else {
        for (std::uint32_t i = node.first; i < end; ++i) {
          const std::uint64_t own = node.count > 1 ? crossed_groups(boxes_[i], apex, shaft, crossed) : crossed;
          if (own != kOutside && !visit(order_[i], own == 0 && may_be_inside)) return;
        }
      }
    }
  }

  // Calls visit(index, depth) for every box, in the order of query, without those in parts of the tree for whose common
  // box enter(box, depth) is false. Parts of a part have the depth after its own; visit gets the depth of the last
  // part.
  template <class Enter, class Visit>
  void visit_where(const Enter& enter, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::pair<std::uint32_t, std::size_t> stack[kDepthLimit];
    int size = 0;
    stack[size++] = {0, 0};
    while (size > 0) {
      const auto [at, depth] = stack[--size];
      const Node& node = nodes_[at];
      if (!enter(node.box, depth)) continue;
      if (node.count > kLeafSize) {
        stack[size++] = {node.right, depth + 1};
        stack[size++] = {at + 1, depth + 1};
      } else {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(order_[i], depth);
      }
    }
  }

  // Calls visit(index) for every box that the ray may meet at a t of at most the limit, nearer parts of the tree first.
  // visit returns the limit for the boxes that follow.
  template <class Visit>
  void along_ray(const RaySlabs& ray, const Visit& visit) const {
    if (nodes_.empty()) return;
    double limit = std::numeric_limits<double>::max();
    std::pair<double, std::uint32_t> stack[kDepthLimit];
    int size = 0;
    stack[size++] = {ray.entry(nodes_[0].box), 0};
    while (size > 0) {
      const auto [entry, at] = stack[--size];
      if (entry > limit) continue;
      const Node& node = nodes_[at];
      if (node.count > kLeafSize) {
        std::pair<double, std::uint32_t> near{ray.entry(nodes_[at + 1].box), at + 1};
        std::pair<double, std::uint32_t> far{ray.entry(nodes_[node.right].box), node.right};
        if (far.first < near.first) std::swap(near, far);
        stack[size++] = far;
        stack[size++] = near;
      } else {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          if (ray.entry(boxes_[i]) <= limit) limit = visit(order_[i]);
        }
      }
    }
  }

  static bool certainly_outside(const Box& box, const Vec3& apex, std::span<const HalfSpace> shaft);
  static bool certainly_inside(const Box& box, const Vec3& apex, const HalfSpace& half_space);

  // A set of groups of half-spaces as bits; groups beyond the 62nd are always tested.
  static constexpr std::size_t kGroupBits = 62;
  static constexpr std::uint64_t kAllGroups = (std::uint64_t{1} << kGroupBits) - 1;
  static constexpr std::uint64_t kOutside = std::uint64_t{1} << 63U;
  // Of the groups in `asked`, those with a half-space that may cut the box. The box, and so every part of it, certainly
  // lies inside the other groups. kOutside if the box lies certainly outside one half-space.
  static std::uint64_t crossed_groups(const Box& box, const Vec3& apex, std::span<const HalfSpaceGroups::Group> shaft,
                                      std::uint64_t asked);

 private:
  static constexpr int kDepthLimit = 64;  // the tree is balanced: depth <= 32 for any 32-bit count
  static constexpr std::uint32_t kLeafSize = 4;

  struct Waiting {
    std::uint32_t node;
    std::uint64_t crossed;
  };

  struct Node {  // the left child follows its parent
    Box box;
    std::uint32_t right = 0;  // of a leaf: 0
    std::uint32_t first = 0;  // into order_
    std::uint32_t count = 0;
  };

  void build(std::span<const Box> boxes, std::uint32_t first, std::uint32_t last);
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;  // in the order of order_
};

class Scene;

[[nodiscard]] Box box_of(const Scene& scene, std::span<const std::uint32_t> corners);

// The tree over the scene's pieces, built at the first call; safe to call from several threads.
const ShaftTree& shaft_tree(const Scene& scene);

// The pieces whose bounding boxes come within `reach` of a box, until `visit` returns false.
template <class Visit>
void visit_pieces_near(const Scene& scene, const Box& box, double reach, const Visit& visit) {
  const Vec3& low = box.low;
  const HalfSpace beyond_low[] = {{{1, 0, 0}, -reach}, {{0, 1, 0}, -reach}, {{0, 0, 1}, -reach}};
  const Vec3 size{box.high.x - low.x + reach, box.high.y - low.y + reach, box.high.z - low.z + reach};
  const HalfSpace half_spaces[] = {beyond_low[0],         beyond_low[1],         beyond_low[2],
                                   {{-1, 0, 0}, -size.x}, {{0, -1, 0}, -size.y}, {{0, 0, -1}, -size.z}};
  shaft_tree(scene).query(low, half_spaces, visit);
}

// --- Extent ---

// The size of a scene: estimates for diagnoses, on which no value depends.

struct Extent {
  double largest = 0.0;   // coordinate in magnitude
  double diameter = 0.0;  // diagonal of the bounding box, clamped to finite doubles
  double scale = 1.0;     // the power of two that brings the largest coordinate into [1/2, 1)
};

// Of the faces with area. Computed at the first call; safe to call from several threads.
const Extent& extent(const Scene& scene);

}  // namespace exactff
