// One face, exactly.
//
// 1. Consecutive vertices at one position are dropped (the lowest index stays, so that the start does not matter).
// 2. Corners become integer points relative to the first one; Newell's vector N and everything below is exact.
// 3. All corners on one line: no area. All in one plane: the face keeps its shape, as one convex part or as the
//    convex parts of planar_region.h. Otherwise the rule of clip_ears along N.
// The decisions use the signs of integer determinants; only newell, area and out_of_plane are rounded.
#include "scene/triangulation.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/planar_region.h"
#include "scene/scene.h"
#include "scene/selections.h"

namespace exactff {

using kernel::ExactVec3;
using kernel::is_zero;

namespace {

Ring without_repetitions(std::span<const Vec3> vertices, const Ring& ring) {
  Ring kept;
  for (const std::uint32_t v : ring) {
    if (!kept.empty() && vertices[kept.back()] == vertices[v]) {
      kept.back() = std::min(kept.back(), v);
    } else {
      kept.push_back(v);
    }
  }
  while (kept.size() > 1 && vertices[kept.front()] == vertices[kept.back()]) {
    kept.front() = std::min(kept.front(), kept.back());
    kept.pop_back();
  }
  return kept;
}

// Works on one face; `face_` is the result.
class FaceCutter {
 public:
  FaceCutter(std::span<const Vec3> vertices, const std::vector<Ring>& rings) : vertices_(vertices) {
    for (const Ring& ring : rings) face_.rings.push_back(without_repetitions(vertices, ring));
    points_ = face_points(vertices, face_.rings);
  }

  CutFace run() {
    cut();
    if (face_.fault) {
      face_.shape = FaceShape::kSkipped;
      face_.parts.clear();
      face_.area = 0.0;
    }
    return std::move(face_);
  }

 private:
  void cut() {
    const ExactVec3 normal = some_normal(points_);
    if (is_zero(normal)) {
      face_.shape = FaceShape::kZeroArea;
      return;
    }
    const bool triangle = points_.size() == 3 && points_.ring_count() == 1;
    newell_ = triangle ? normal : newell(points_, 0, points_.ring_start[1]);
    face_.newell = nearest_vector(newell_, 2 * points_.exponent - 1);
    if (triangle) {
      take_triangle();
    } else if (all_in_plane(points_, normal)) {
      cut_planar(normal);
    } else {
      cut_other();
    }
    face_.area = to_double({twice_area_.mantissa, twice_area_.exponent + 2 * points_.exponent - 1});
  }

  // By far the most common face, always planar and convex.
  void take_triangle() {
    const std::vector<std::uint32_t>& v = points_.vertex;
    face_.parts.push_back({v, {v[0], v[1], v[2]}});
    twice_area_ = length(newell_);
  }

  void cut_planar(const ExactVec3& normal) {
    if (is_zero(newell_)) return without_newell(normal);
    const PlanePoints plane(points_, newell_, PlanePoints::Projection::kDropAxis);
    if (!is_convex(plane)) return cut_region(plane);
    std::vector<std::size_t> all(points_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    add_part(plane, all);
  }

  void cut_region(const PlanePoints& plane) {
    const PlanarRegion region = planar_region(vertices_, points_, plane, newell_);
    report(region);
    for (const auto& part : region.parts) add_part(plane, part);
    if (!face_.fault && face_.parts.empty()) face_.shape = FaceShape::kZeroArea;  // the holes remove everything
  }

  // Planar, with corners not on one line: a tree of edges walked there and back, or two lobes of opposite sense.
  void without_newell(const ExactVec3& normal) {
    const PlanePoints plane(points_, normal, PlanePoints::Projection::kDropAxis);
    const PlanarRegion region = planar_region(vertices_, points_, plane, normal);
    if (region.fault == RegionFault::kCrossing) return report(region);
    face_.shape = FaceShape::kZeroArea;
    if (region.encloses_something) {
      face_.fault = {"encloses area, but its Newell vector (area times normal) is zero", "it has no front side",
                     "split it into simple polygons"};
    }
  }

  void cut_other() {
    face_.shape = FaceShape::kTriangulated;
    if (points_.ring_count() > 1) {
      face_.fault = {"has holes, but its vertices are not exactly in one plane",
                     "the position of the holes is not defined",
                     "connect the holes to the outer ring, or use triangles"};
      return;
    }
    if (is_zero(newell_)) {
      face_.fault = {"has area, but its Newell vector (area times normal) is zero", "it has no front side",
                     "split it into simple polygons"};
      return;
    }
    face_.out_of_plane = out_of_plane(points_, newell_);
    const PlanePoints plane(points_, newell_, PlanePoints::Projection::kAlongNormal);
    const auto triangles = clip_ears(plane, points_.vertex);
    if (const auto crossing = triangles && points_.size() == 4 ? std::nullopt : find_crossing(points_, plane)) {
      return report_crossing(*crossing);
    }
    if (!triangles) {
      face_.fault = {
          "is not planar, and its projection along its Newell vector (area times normal) is not a simple polygon",
          "it cannot be cut into triangles", "split it into simple polygons"};
      return;
    }
    if (leaves_gap(*triangles)) {
      face_.fault = {
          "is not planar, and some of its corners coincide when projected along its Newell vector (area times normal)",
          "triangulated in this projection, it would have a gap", "split it into simple polygons"};
      return;
    }
    for (const TriangleIndices& triangle : *triangles) add_part(plane, triangle);
  }

  // Turns left or goes straight on at every corner, and goes around once: the x direction changes its sign twice.
  bool is_convex(const PlanePoints& plane) const {
    const std::size_t n = points_.size();
    if (points_.ring_count() > 1) return false;
    int changes = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const std::size_t k = (i + 2) % n;
      if (plane.orientation(i, j, k) < 0) return false;
      if (plane.compare(i, j) != plane.compare(j, k)) ++changes;
    }
    return changes == 2;
  }

  // True if anything but the ring bounds the triangles in space, not only as seen along the Newell vector.
  bool leaves_gap(const std::vector<TriangleIndices>& triangles) const {
    using Position = std::tuple<double, double, double>;
    std::vector<std::pair<Position, Position>> sides, reversed;
    const auto place = [&](std::size_t point) {
      const Vec3& v = vertices_[points_.vertex[point]];
      return Position{v.x, v.y, v.z};
    };
    const auto add = [&](std::size_t from, std::size_t to) {
      const Position a = place(from), b = place(to);
      if (a < b) sides.emplace_back(a, b);
      if (b < a) reversed.emplace_back(b, a);
    };
    for (const auto& [a, b, c] : triangles) {
      add(a, b);
      add(b, c);
      add(c, a);
    }
    for (std::size_t i = 0; i < points_.size(); ++i) add(next_in_ring(points_, i), i);
    std::sort(sides.begin(), sides.end());
    std::sort(reversed.begin(), reversed.end());
    return sides != reversed;
  }

  void add_part(const PlanePoints& plane, std::span<const std::size_t> corners) {
    ConvexPart part;
    for (const std::size_t corner : corners) part.corners.push_back(points_.vertex[corner]);
    std::size_t third = 2;
    while (corners.size() > 3 && plane.orientation(corners[0], corners[1], corners[third]) == 0) ++third;
    part.frame = {part.corners[0], part.corners[1], part.corners[third]};
    twice_area_ = twice_area_ + length(newell(points_, corners));
    face_.parts.push_back(std::move(part));
  }

  void report(const PlanarRegion& region) {
    switch (region.fault) {
      case RegionFault::kNone:
        return;
      case RegionFault::kCrossing:
        return report_crossing(region.edges);
      case RegionFault::kWinding:
        face_.fault = {"winds around a part of its interior twice, or in the opposite direction",
                       "its front side is ambiguous", "split it into simple polygons"};
        return;
      case RegionFault::kHoleOutside:
        face_.fault = {"has a hole that reaches outside its outer ring", "a hole must lie inside its face",
                       "make it a separate face, or move it"};
        return;
    }
  }

  void report_crossing(std::pair<EdgeIndex, EdgeIndex> edges) {
    const bool holes = edges.second >= points_.ring_start[1];
    face_.fault = {"crosses itself: edge " + edge_text(edges.first) + " and edge " + edge_text(edges.second) +
                       " (vertex numbers) intersect",
                   holes ? "a hole must lie inside its face" : "its interior is ambiguous",
                   "split it into simple polygons"};
  }

  std::string edge_text(EdgeIndex edge) const {
    return std::to_string(points_.vertex[edge] + 1) + "-" +
           std::to_string(points_.vertex[next_in_ring(points_, edge)] + 1);
  }

  std::span<const Vec3> vertices_;
  FacePoints points_;
  ExactVec3 newell_;  // of the outer ring, twice its area
  Length twice_area_;
  CutFace face_;
};

}  // namespace

CutFace cut_face(std::span<const Vec3> vertices, const std::vector<Ring>& rings) {
  EXACTFF_EXPECT(std::ranges::all_of(rings, [&](const Ring& ring) {
    return std::ranges::all_of(ring,
                               [&](std::uint32_t v) { return v < vertices.size() && kernel::is_finite(vertices[v]); });
  }));
  return FaceCutter(vertices, rings).run();
}

// --- Ear clipping ---

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

namespace {

// --- Position tree ---

// The positions of a polygon's points in a tree, which finds a marked position in a triangle.

// A position stands for all points at one place. A tree of boxes over them (median splits; the depth is logarithmic
// whatever the points) counts the marks below each node, so that a search skips nodes without marks. Searches and marks
// take about O(log n).
class PositionTree {
 public:
  using Position = std::uint32_t;

  PositionTree(const PlanePoints& plane) : plane_(plane) {
    find_positions();
    marks_.resize(point_at_.size());
    leaf_of_.resize(point_at_.size());
    order_.resize(point_at_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()), 0);
  }

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
  [[nodiscard]] std::optional<Position> find_marked(std::size_t a, std::size_t b, std::size_t c) const {
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

  void find_positions() {
    std::vector<std::size_t> order(plane_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return plane_.compare(a, b) < 0; });
    position_of_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i == 0 || plane_.compare(order[i - 1], order[i]) != 0) point_at_.push_back(order[i]);
      position_of_[order[i]] = static_cast<Position>(point_at_.size() - 1);
    }
  }

  void build(std::uint32_t first, std::uint32_t last, std::uint32_t parent) {
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

  void change(Position position, int by) {
    const auto step = static_cast<std::uint32_t>(by);  // subtracting one mark adds 2^32 - 1
    marks_[position] += step;
    std::uint32_t node = leaf_of_[position];
    for (; node != 0; node = nodes_[node].parent) nodes_[node].marks += step;
    nodes_[0].marks += step;
  }

  [[nodiscard]] double x(Position position) const { return plane_.x(point_at_[position]); }
  [[nodiscard]] double y(Position position) const { return plane_.y(point_at_[position]); }

  // Proved by the bound of PlanePoints::orientation, which also holds for the box's corner farthest to the left of a
  // side, or by the bounding box.
  [[nodiscard]] bool certainly_outside(const Node& node, const Triangle& triangle) const {
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

  [[nodiscard]] bool holds(const Triangle& triangle, Position position) const {
    const auto& [a, b, c] = triangle.corners;
    if (position == position_of_[a] || position == position_of_[b] || position == position_of_[c]) return false;
    const std::size_t point = point_at_[position];
    return plane_.orientation(a, b, point) >= 0 && plane_.orientation(b, c, point) >= 0 &&
           plane_.orientation(c, a, point) >= 0;
  }

  [[nodiscard]] std::optional<Position> find_in_leaf(const Node& leaf, const Triangle& triangle) const {
    for (std::uint32_t i = leaf.first; i < leaf.last; ++i) {
      if (marks_[order_[i]] > 0 && holds(triangle, order_[i])) return order_[i];
    }
    return std::nullopt;
  }

  const PlanePoints& plane_;
  std::vector<Position> position_of_;   // of each point
  std::vector<std::size_t> point_at_;   // one of the points at each position
  std::vector<std::uint32_t> marks_;    // at each position
  std::vector<Position> order_;         // of the leaves
  std::vector<std::uint32_t> leaf_of_;  // of each position, into nodes_
  std::vector<Node> nodes_;
};

class EarClipper {
 public:
  EarClipper(const PlanePoints& plane, std::span<const std::uint32_t> index)
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

  std::optional<std::vector<TriangleIndices>> run() {
    std::vector<TriangleIndices> triangles;
    while (count_ > 2) {
      if (valid_.empty()) return std::nullopt;
      triangles.push_back(clip(std::get<3>(*valid_.begin())));
    }
    return triangles;
  }

 private:
  using Order = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::size_t>;

  // Two visits of the ring to one vertex are distinguished by the neighbours, so that the start does not matter.
  Order order_of(std::size_t tip) const {
    const auto [low, high] = std::minmax(index_[previous_[tip]], index_[next_[tip]]);
    return {index_[tip], low, high, tip};
  }

  void examine(std::size_t tip) {
    if (!is_convex(tip)) return;
    if (const auto blocker = tree_.find_marked(previous_[tip], tip, next_[tip])) {
      waiting_[*blocker].push_back(tip);
    } else {
      valid_.insert(order_of(tip));
    }
  }

  // Must be called when a vertex has new neighbours.
  void refresh(std::size_t vertex) {
    if (is_convex(vertex)) {
      stop_blocking(vertex);
    } else {
      start_blocking(vertex);
    }
    if (!valid_.contains(order_of(vertex))) examine(vertex);
  }

  void start_blocking(std::size_t vertex) {
    if (!blocks_[vertex]) tree_.mark(vertex);
    blocks_[vertex] = true;
  }

  void stop_blocking(std::size_t vertex) {
    if (!blocks_[vertex]) return;
    blocks_[vertex] = false;
    if (!tree_.unmark(vertex)) return;
    for (const std::size_t tip : std::exchange(waiting_[tree_.position_of(vertex)], {})) {
      if (present_[tip] && !valid_.contains(order_of(tip))) examine(tip);
    }
  }

  // The caller must refresh the two neighbours.
  void remove(std::size_t vertex) {
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
  std::size_t settle(std::size_t vertex) {
    while (count_ > 2 && same_position(previous_[vertex], next_[vertex])) {
      const std::size_t a = previous_[vertex], c = next_[vertex];
      remove(vertex);
      vertex = index_[a] <= index_[c] ? a : c;
      remove(vertex == a ? c : a);
    }
    return vertex;
  }

  TriangleIndices clip(std::size_t tip) {
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

// --- Triangles ---

// Some corners of a piece may be on a straight side, so a fan from one corner would not do.
std::vector<std::vector<std::uint32_t>> triangles_of(const Scene& scene, const Piece& piece) {
  const auto corners = scene.corners(piece);
  const std::vector<std::uint32_t> ring(corners.begin(), corners.end());
  if (ring.size() == 3) return {ring};
  const FacePoints points = face_points(scene.vertices(), {ring});
  const PlanePoints plane(points, newell(points, 0, points.size()), PlanePoints::Projection::kDropAxis);
  const auto triangles = clip_ears(plane, points.vertex);
  EXACTFF_EXPECT(triangles.has_value());
  std::vector<std::vector<std::uint32_t>> result;
  for (const auto& [a, b, c] : *triangles) result.push_back({ring[a], ring[b], ring[c]});
  return result;
}

Scene triangulated(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  SceneBuilder builder({}, {.unit = scene.unit()});
  for (const Vec3& vertex : scene.vertices()) builder.add_vertex(vertex);
  for (const Material& material : scene.materials()) builder.add_material(material);
  for (const Patch& patch : scene.patches()) (void)builder.patch(patch.name);
  std::vector<FaceId> transparent;
  std::uint32_t count = 0;
  for (const Piece& piece : scene.pieces()) {
    const Face& face = scene.face(piece.face);
    for (std::vector<std::uint32_t>& triangle : triangles_of(scene, piece)) {
      if (face.transparent) transparent.push_back(static_cast<FaceId>(count));
      builder.add_face(face.patch, face.material, {triangle});
      copy_texture(scene, piece.face, {std::move(triangle)}, builder);
      ++count;
    }
  }
  const Scene made = builder.build();
  return made.with_transparent(selections_of(made, std::move(transparent)));
}

}  // namespace exactff
