// The positions of a polygon's points in a tree, which finds a marked position in a triangle.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/face_points.h"

namespace exactff {

// A position stands for all points at one place. A tree of boxes over them (median splits; the depth is logarithmic
// whatever the points) counts the marks below each node, so that a search skips nodes without marks. Searches and marks
// take about O(log n).
class PositionTree {
 public:
  using Position = std::uint32_t;

  explicit PositionTree(const PlanePoints& plane);

  [[nodiscard]] Position position_of(std::size_t point) const { return position_of_[point]; }
  [[nodiscard]] std::size_t position_count() const { return marks_.size(); }

  void mark(std::size_t point) { change(position_of_[point], 1); }
  // True if its position has no mark left.
  bool unmark(std::size_t point) {
    change(position_of_[point], -1);
    return marks_[position_of_[point]] == 0;
  }

  // A marked position in the closed triangle a, b, c (counter-clockwise) other than its corners; of several, one that
  // is about the farthest from the side c-a. Exact.
  [[nodiscard]] std::optional<Position> find_marked(std::size_t a, std::size_t b, std::size_t c) const;

 private:
  static constexpr std::uint32_t kLeafSize = 4;
  static constexpr int kDepthLimit = 64;  // the tree is balanced: depth <= 32 for any 32-bit count

  struct Node {  // the left child follows its parent
    double low_x, high_x, low_y, high_y;
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::uint32_t parent = 0;
    std::uint32_t right = 0;  // 0 for a leaf
    std::uint32_t marks = 0;
  };
  struct Triangle {
    std::array<std::size_t, 3> corners;
    double low_x, high_x, low_y, high_y;
  };

  void find_positions();
  void build(std::uint32_t first, std::uint32_t last, std::uint32_t parent);
  void change(Position position, int by);
  [[nodiscard]] double x(Position position) const { return plane_.x(point_at_[position]); }
  [[nodiscard]] double y(Position position) const { return plane_.y(point_at_[position]); }
  [[nodiscard]] bool certainly_outside(const Node& node, const Triangle& triangle) const;
  [[nodiscard]] bool holds(const Triangle& triangle, Position position) const;
  [[nodiscard]] std::optional<Position> find_in_leaf(const Node& leaf, const Triangle& triangle) const;

  const PlanePoints& plane_;
  std::vector<Position> position_of_;   // of each point
  std::vector<std::size_t> point_at_;   // one of the points at each position
  std::vector<std::uint32_t> marks_;    // at each position
  std::vector<Position> order_;         // of the leaves
  std::vector<std::uint32_t> leaf_of_;  // of each position, into nodes_
  std::vector<Node> nodes_;
};

}  // namespace exactff
