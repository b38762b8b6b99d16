// Ear clipping by the lowest index, exactly.
//
// The ring is a linked list; `valid_` holds the tips of all valid ears in the order in which they are to be clipped.
// Clipping a tip changes the ears of its two neighbours. Any other ear can only become valid, and only when the
// position that was found to block it disappears; each blocked ear therefore waits in the list of that position.
// Blockers are found in a tree of positions. Of several blockers, one far from the ear's base is chosen, since it stays
// longest.
// Only vertices that are not strictly convex need to be considered as blockers: of the vertices in an ear, the one
// farthest from its base is reflex or straight, or else it touches the ear's side from outside the polygon and does not
// block.
// Source: G. H. Meisters, "Polygons have ears" (1975); H. ElGindy, H. Everett and G. Toussaint (1993).
#include "scene/ear_clipping.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "scene/position_tree.h"

namespace exactff {

namespace {

class EarClipper {
 public:
  EarClipper(const PlanePoints& plane, std::span<const std::uint32_t> index);
  std::optional<std::vector<TriangleIndices>> run();

 private:
  using Order = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t>;

  Order order_of(std::size_t tip) const;
  void examine(std::size_t tip);
  void refresh(std::size_t vertex);
  void start_blocking(std::size_t vertex);
  void stop_blocking(std::size_t vertex);
  void remove(std::size_t vertex);
  std::size_t settle(std::size_t vertex);
  TriangleIndices clip(std::size_t tip);

  bool same_position(std::size_t a, std::size_t b) const { return tree_.position_of(a) == tree_.position_of(b); }
  bool is_convex(std::size_t v) const { return plane_.orientation(previous_[v], v, next_[v]) > 0; }

  const PlanePoints& plane_;
  std::span<const std::uint32_t> index_;
  std::vector<std::size_t> next_;
  std::vector<std::size_t> previous_;
  std::vector<bool> present_;
  std::size_t count_ = 0;
  std::set<Order> valid_;
  std::vector<bool> blocks_;                       // vertices that are not strictly convex
  PositionTree tree_;                              // has marks where they are
  std::vector<std::vector<std::size_t>> waiting_;  // tips blocked from each position
};

EarClipper::EarClipper(const PlanePoints& plane, std::span<const std::uint32_t> index)
    : plane_(plane),
      index_(index),
      present_(index.size(), true),
      count_(index.size()),
      blocks_(index.size(), false),
      tree_(plane),
      waiting_(tree_.position_count()) {
  const std::size_t n = index.size();
  for (std::size_t v = 0; v < n; ++v) {
    next_.push_back((v + 1) % n);
    previous_.push_back((v + n - 1) % n);
  }
  for (std::size_t v = 0; v < n; ++v) {
    if (!is_convex(v)) start_blocking(v);
  }
  for (std::size_t v = 0; v < n; ++v) examine(v);
}

// Two visits of the ring to one vertex are distinguished by the neighbours, so that the start does not matter.
EarClipper::Order EarClipper::order_of(std::size_t tip) const {
  const auto [low, high] = std::minmax(index_[previous_[tip]], index_[next_[tip]]);
  return {index_[tip], low, high, tip};
}

void EarClipper::examine(std::size_t tip) {
  if (!is_convex(tip)) return;
  if (const auto blocker = tree_.find_marked(previous_[tip], tip, next_[tip])) {
    waiting_[*blocker].push_back(tip);
  } else {
    valid_.insert(order_of(tip));
  }
}

// Must be called when a vertex has new neighbours.
void EarClipper::refresh(std::size_t vertex) {
  if (is_convex(vertex)) {
    stop_blocking(vertex);
  } else {
    start_blocking(vertex);
  }
  if (!valid_.contains(order_of(vertex))) examine(vertex);
}

void EarClipper::start_blocking(std::size_t vertex) {
  if (!blocks_[vertex]) tree_.mark(vertex);
  blocks_[vertex] = true;
}

void EarClipper::stop_blocking(std::size_t vertex) {
  if (!blocks_[vertex]) return;
  blocks_[vertex] = false;
  if (!tree_.unmark(vertex)) return;
  for (const std::size_t tip : std::exchange(waiting_[tree_.position_of(vertex)], {})) {
    if (present_[tip] && !valid_.contains(order_of(tip))) examine(tip);
  }
}

// The caller must refresh the two neighbours.
void EarClipper::remove(std::size_t vertex) {
  const std::size_t a = previous_[vertex], c = next_[vertex];
  for (const std::size_t v : {a, vertex, c}) valid_.erase(order_of(v));
  present_[vertex] = false;
  --count_;
  next_[a] = c;
  previous_[c] = a;
  stop_blocking(vertex);
}

// Where a ring touches itself at a vertex, using up one of its lobes leaves two sides that coincide: drops the
// corner between them and one of the two equal vertices then left side by side, until the sides differ. Returns
// the vertex that is left in their place.
std::size_t EarClipper::settle(std::size_t vertex) {
  while (count_ > 2 && same_position(previous_[vertex], next_[vertex])) {
    const std::size_t a = previous_[vertex], c = next_[vertex];
    remove(vertex);
    vertex = index_[a] <= index_[c] ? a : c;
    remove(vertex == a ? c : a);
  }
  return vertex;
}

TriangleIndices EarClipper::clip(std::size_t tip) {
  const TriangleIndices triangle = {previous_[tip], tip, next_[tip]};
  remove(tip);
  for (const std::size_t end : {triangle[0], triangle[2]}) {
    if (!present_[end]) continue;
    const std::size_t left = settle(end);
    refresh(left);
    if (left == end) continue;
    refresh(previous_[left]);
    refresh(next_[left]);
  }
  return triangle;
}

std::optional<std::vector<TriangleIndices>> EarClipper::run() {
  std::vector<TriangleIndices> triangles;
  while (count_ > 2) {
    if (valid_.empty()) return std::nullopt;
    triangles.push_back(clip(std::get<3>(*valid_.begin())));
  }
  return triangles;
}

std::optional<std::vector<TriangleIndices>> split_quadrilateral(const PlanePoints& plane,
                                                                std::span<const std::uint32_t> index) {
  const auto lowest = static_cast<std::size_t>(std::min_element(index.begin(), index.end()) - index.begin());
  for (const std::size_t a : {lowest, lowest + 1}) {
    const TriangleIndices first = {a % 4, (a + 1) % 4, (a + 2) % 4};
    const TriangleIndices second = {a % 4, (a + 2) % 4, (a + 3) % 4};
    const auto runs_left = [&](const TriangleIndices& t) { return plane.orientation(t[0], t[1], t[2]) > 0; };
    if (runs_left(first) && runs_left(second)) return std::vector{first, second};
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<TriangleIndices>> clip_ears(const PlanePoints& plane, std::span<const std::uint32_t> index) {
  if (index.size() == 4) return split_quadrilateral(plane, index);
  return EarClipper(plane, index).run();
}

}  // namespace exactff
