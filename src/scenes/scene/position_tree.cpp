#include "scene/position_tree.h"

#include <algorithm>
#include <numeric>

namespace exactff {

PositionTree::PositionTree(const PlanePoints& plane) : plane_(plane) {
  find_positions();
  marks_.resize(point_at_.size());
  leaf_of_.resize(point_at_.size());
  order_.resize(point_at_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()), 0);
}

void PositionTree::find_positions() {
  std::vector<std::size_t> order(plane_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return plane_.compare(a, b) < 0; });
  position_of_.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || plane_.compare(order[i - 1], order[i]) != 0) point_at_.push_back(order[i]);
    position_of_[order[i]] = static_cast<Position>(point_at_.size() - 1);
  }
}

void PositionTree::build(std::uint32_t first, std::uint32_t last, std::uint32_t parent) {
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  Node node{x(order_[first]), x(order_[first]), y(order_[first]), y(order_[first]), first, last, parent};
  for (std::uint32_t i = first + 1; i < last; ++i) {
    node.low_x = std::min(node.low_x, x(order_[i]));
    node.high_x = std::max(node.high_x, x(order_[i]));
    node.low_y = std::min(node.low_y, y(order_[i]));
    node.high_y = std::max(node.high_y, y(order_[i]));
  }
  nodes_.push_back(node);
  if (last - first <= kLeafSize) {
    for (std::uint32_t i = first; i < last; ++i) leaf_of_[order_[i]] = self;
    return;
  }
  const bool along_x = node.high_x - node.low_x >= node.high_y - node.low_y;
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](Position a, Position b) { return along_x ? x(a) < x(b) : y(a) < y(b); });
  build(first, middle, self);
  nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
  build(middle, last, self);
}

void PositionTree::change(Position position, int by) {
  const auto step = static_cast<std::uint32_t>(by);  // subtracting one mark adds 2^32 - 1
  marks_[position] += step;
  std::uint32_t node = leaf_of_[position];
  for (; node != 0; node = nodes_[node].parent) nodes_[node].marks += step;
  nodes_[0].marks += step;
}

// Proved by the bound of PlanePoints::orientation, which also holds for the box's corner farthest to the left of a
// side, or by the bounding box.
bool PositionTree::certainly_outside(const Node& node, const Triangle& triangle) const {
  constexpr double kMargin = 4 * PlanePoints::kApproximation;
  if (node.low_x > triangle.high_x + kMargin || node.high_x < triangle.low_x - kMargin ||
      node.low_y > triangle.high_y + kMargin || node.high_y < triangle.low_y - kMargin) {
    return true;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t p = triangle.corners[i], q = triangle.corners[(i + 1) % 3];
    const double dx = plane_.x(q) - plane_.x(p), dy = plane_.y(q) - plane_.y(p);
    const double corner_x = dy > 0.0 ? node.low_x : node.high_x;
    const double corner_y = dx > 0.0 ? node.high_y : node.low_y;
    if (dx * (corner_y - plane_.y(p)) - dy * (corner_x - plane_.x(p)) < -PlanePoints::kOrientationError) return true;
  }
  return false;
}

bool PositionTree::holds(const Triangle& triangle, Position position) const {
  const auto& [a, b, c] = triangle.corners;
  if (position == position_of_[a] || position == position_of_[b] || position == position_of_[c]) return false;
  const std::size_t point = point_at_[position];
  return plane_.orientation(a, b, point) >= 0 && plane_.orientation(b, c, point) >= 0 &&
         plane_.orientation(c, a, point) >= 0;
}

std::optional<PositionTree::Position> PositionTree::find_in_leaf(const Node& leaf, const Triangle& triangle) const {
  for (std::uint32_t i = leaf.first; i < leaf.last; ++i) {
    if (marks_[order_[i]] > 0 && holds(triangle, order_[i])) return order_[i];
  }
  return std::nullopt;
}

std::optional<PositionTree::Position> PositionTree::find_marked(std::size_t a, std::size_t b, std::size_t c) const {
  const auto [low_x, high_x] = std::minmax({plane_.x(a), plane_.x(b), plane_.x(c)});
  const auto [low_y, high_y] = std::minmax({plane_.y(a), plane_.y(b), plane_.y(c)});
  const Triangle triangle{{a, b, c}, low_x, high_x, low_y, high_y};
  const auto height = [&](const Node& node) {  // of the box's centre above the side c-a, times a constant
    return (plane_.x(a) - plane_.x(c)) * (node.low_y + node.high_y) -
           (plane_.y(a) - plane_.y(c)) * (node.low_x + node.high_x);
  };
  std::uint32_t stack[kDepthLimit];
  int size = 0;
  if (!nodes_.empty()) stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Node& node = nodes_[index];
    if (node.marks == 0 || certainly_outside(node, triangle)) continue;
    if (node.right == 0) {
      if (const auto found = find_in_leaf(node, triangle)) return found;
      continue;
    }
    const bool right_first = height(nodes_[node.right]) > height(nodes_[index + 1]);
    stack[size++] = right_first ? index + 1 : node.right;
    stack[size++] = right_first ? node.right : index + 1;
  }
  return std::nullopt;
}

}  // namespace exactff
