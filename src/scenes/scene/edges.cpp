// Steps, each in about linear time except for the tree:
//   1. sort the uses by their edges;
//   2. turn pieces over so that neighbours agree, from piece to piece across edges with two uses;
//   3. build the tree by median splits; bound the normals from the leaves upwards.
#include "scene/edges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "kernel/vec.h"
#include "scene/scene.h"

namespace exactff {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

struct NormalBounds {
  std::array<float, 3> least{kNoNumber, kNoNumber, kNoNumber}, largest{kNoNumber, kNoNumber, kNoNumber};
};

float rounded_down(double x) {
  const auto f = static_cast<float>(x);
  return f <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}

NormalBounds turned_over(const NormalBounds& n) {
  NormalBounds result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.least[i] = -n.largest[i];
    result.largest[i] = -n.least[i];
  }
  return result;
}

// Bounds of some positive multiple of the piece's exact normal, of length about 1; NaN if they cannot be found.
//
// Each difference of coordinates, scaled by a power of two so that the largest of its vector is in [1/2, 1), errs
// relatively by u = 2^-53, or by 2^-1074 if it underflows. A product of two errs by 3u of itself, the difference of two
// products by u more of at most their magnitudes' sum: in all by less than 2^-50 of that sum, plus 2^-1000. Dividing by
// the largest component rounds once more, relatively; 2^-49 covers that.
NormalBounds normal_bounds(const Vec3& p, const Vec3& q, const Vec3& r) {
  const auto scaled_difference = [](const Vec3& to, const Vec3& from, std::array<double, 3>& d) {
    d = {to.x - from.x, to.y - from.y, to.z - from.z};
    const double largest = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
    if (!(largest > 0.0) || !std::isfinite(largest)) return false;
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (double& x : d) x = std::ldexp(x, -exponent);
    return true;
  };
  std::array<double, 3> a{}, b{}, n{}, error{};
  if (!scaled_difference(q, p, a) || !scaled_difference(r, p, b)) return {};
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double first = a[j] * b[k], second = a[k] * b[j];
    n[i] = first - second;
    error[i] = 0x1p-49 * (std::abs(first) + std::abs(second)) + 0x1p-1000;
    largest = std::max(largest, std::abs(n[i]));
  }
  if (!(largest > 0x1p-200)) return {};
  NormalBounds bounds;
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = n[i] / largest, radius = error[i] / largest + 0x1p-50;
    bounds.least[i] = rounded_down(middle - radius);
    bounds.largest[i] = -rounded_down(-middle - radius);
  }
  return bounds;
}

void include(Box& box, const Box& other) {
  box.include(other.low);
  box.include(other.high);
}

// NaN if either is.
void include(NormalBounds& bounds, const NormalBounds& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    const float least = other.least[i], largest = other.largest[i];
    if (!(bounds.least[i] <= least)) bounds.least[i] = bounds.least[i] == bounds.least[i] ? least : kNoNumber;
    if (!(bounds.largest[i] >= largest))
      bounds.largest[i] = bounds.largest[i] == bounds.largest[i] ? largest : kNoNumber;
  }
}

}  // namespace

// With u = 2^-53: each difference is rounded once, each product once more, three sums err by at most 3u of the sum m of
// the largest magnitudes: below 6u m in all, against 2^-48 m = 32u m. The bounds of the normals are exact as doubles.
// For a corner p of a piece, in the box, and the piece's normal n, n . (x - p) lies between `low` and `high`.
bool SceneEdges::Node::sees_one_side(const Vec3& x) const {
  double low = 0.0, high = 0.0, m = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double from = kernel::coordinate(x, i) - kernel::coordinate(box.high, i);
    const double to = kernel::coordinate(x, i) - kernel::coordinate(box.low, i);
    const double n = least_normal[static_cast<std::size_t>(i)], k = largest_normal[static_cast<std::size_t>(i)];
    const double a = n * from, b = n * to, c = k * from, d = k * to;
    low += std::min(std::min(a, b), std::min(c, d));
    high += std::max(std::max(a, b), std::max(c, d));
    m += std::max(std::abs(n), std::abs(k)) * std::max(std::abs(from), std::abs(to));
  }
  if (!(m >= 0x1p-900 && m <= 0x1p1000)) return false;
  return low > 0x1p-48 * m || high < -0x1p-48 * m;
}

class SceneEdgesBuilder {
 public:
  SceneEdgesBuilder(const Scene& scene, SceneEdges& result)
      : scene_(scene), pieces_(scene.pieces()), vertices_(scene.vertices()), result_(result) {}

  void build() {
    sort_uses();
    turn_pieces_over();
    const std::size_t count = result_.size();
    if (count == 0) return;
    find_bounds();
    order_.reserve(count);
    for (std::uint32_t edge = 0; edge < count; ++edge) order_.push_back({middle(edge), edge});
    result_.nodes_.reserve(2 * count / kLeafSize + 2);
    add_node(0, static_cast<std::uint32_t>(count));
    number_in_order();
  }

 private:
  void sort_uses() {
    struct Use {
      std::uint32_t high, piece, corner;
      bool upwards;
    };
    const auto place = places(scene_);
    std::vector<std::uint32_t> begin(vertices_.size() + 1, 0);
    const auto for_each_use = [&](const auto& take) {
      for (std::uint32_t p = 0; p < pieces_.size(); ++p) {
        if (pieces_[p].transparent) continue;
        const auto corners = scene_.corners(pieces_[p]);
        for (std::uint32_t c = 0; c < corners.size(); ++c) {
          const std::uint32_t from = place[corners[c]], to = place[corners[c + 1 == corners.size() ? 0 : c + 1]];
          take(std::min(from, to), Use{std::max(from, to), p, pieces_[p].first_corner + c, from < to});
        }
      }
    };
    std::uint32_t corner_count = 0;
    for (const Piece& piece : pieces_) corner_count = std::max(corner_count, piece.first_corner + piece.corner_count);
    for_each_use([&](std::uint32_t low, const Use&) { ++begin[low + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Use> uses(begin.back());
    {
      std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
      for_each_use([&](std::uint32_t low, const Use& use) { uses[next[low]++] = use; });
    }
    result_.edge_of_corner_.resize(corner_count);
    result_.uses_.reserve(uses.size());
    for (std::uint32_t low = 0; low < vertices_.size(); ++low) {
      const auto first = uses.begin() + begin[low], last = uses.begin() + begin[low + 1];
      std::stable_sort(first, last, [](const Use& a, const Use& b) { return a.high < b.high; });
      for (auto use = first; use != last; ++use) {
        if (use == first || use->high != (use - 1)->high) {
          result_.edges_.push_back({low, use->high, static_cast<std::uint32_t>(result_.uses_.size())});
        }
        result_.edge_of_corner_[use->corner] = static_cast<std::uint32_t>(result_.edges_.size() - 1);
        result_.uses_.emplace_back(use->piece, use->upwards);
      }
    }
    if (!result_.edges_.empty()) result_.edges_.push_back({0, 0, static_cast<std::uint32_t>(result_.uses_.size())});
    result_.edges_.shrink_to_fit();
  }

  void turn_pieces_over() {
    turned_.assign(pieces_.size(), 0);
    std::vector<std::uint8_t> reached(pieces_.size(), 0);
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t seed = 0; seed < pieces_.size(); ++seed) {
      if (reached[seed] != 0 || pieces_[seed].transparent) continue;
      reached[seed] = 1;
      waiting.assign(1, seed);
      while (!waiting.empty()) {
        const std::uint32_t piece = waiting.back();
        waiting.pop_back();
        for (const std::uint32_t edge : result_.of_piece(pieces_[piece])) {
          const auto uses = result_.uses(edge);
          if (uses.size() != 2) continue;
          const EdgeUse& other = uses[uses[0].piece() == piece ? 1 : 0];
          if (reached[other.piece()] != 0) continue;
          reached[other.piece()] = 1;
          turned_[other.piece()] = turned_[piece] ^ (uses[0].upwards() == uses[1].upwards() ? 1U : 0U);
          waiting.push_back(other.piece());
        }
      }
    }
  }

  void find_bounds() {
    normals_.resize(pieces_.size());
    for (std::uint32_t p = 0; p < pieces_.size(); ++p) {
      const auto& frame = pieces_[p].frame;
      const NormalBounds n = normal_bounds(vertices_[frame[0]], vertices_[frame[1]], vertices_[frame[2]]);
      normals_[p] = turned_[p] != 0 ? turned_over(n) : n;
    }
  }

  void add_node(std::uint32_t first, std::uint32_t last) {
    const auto index = static_cast<std::uint32_t>(result_.nodes_.size());
    result_.nodes_.emplace_back();
    Box box;
    NormalBounds normals;
    if (last - first <= kLeafSize) {
      box = box_of_edge(order_[first].edge);
      normals = normals_of_edge(order_[first].edge);
      for (std::uint32_t i = first + 1; i < last; ++i) {
        include(box, box_of_edge(order_[i].edge));
        include(normals, normals_of_edge(order_[i].edge));
      }
    } else {
      Box middles{order_[first].middle, order_[first].middle};
      for (std::uint32_t i = first + 1; i < last; ++i) middles.include(order_[i].middle);
      const int axis = longest_axis(middles);
      const std::uint32_t half = first + (last - first) / 2;
      std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                       [&](const Placed& a, const Placed& b) {
                         const double u = kernel::coordinate(a.middle, axis), v = kernel::coordinate(b.middle, axis);
                         return u != v ? u < v : a.edge < b.edge;
                       });
      add_node(first, half);
      const auto right = static_cast<std::uint32_t>(result_.nodes_.size());
      add_node(half, last);
      SceneEdges::Node &node = result_.nodes_[index], &l = result_.nodes_[index + 1], &r = result_.nodes_[right];
      node.right = right;
      box = l.box;
      include(box, r.box);
      normals = {l.least_normal, l.largest_normal};
      include(normals, {r.least_normal, r.largest_normal});
    }
    SceneEdges::Node& node = result_.nodes_[index];
    node.box = box;
    node.least_normal = normals.least;
    node.largest_normal = normals.largest;
    node.first = first;
    node.last = last;
  }

  // Edges that are near each other get numbers that are near each other, and so do their uses.
  void number_in_order() {
    std::vector<SceneEdge> edges;
    std::vector<EdgeUse> uses;
    std::vector<std::uint32_t> number(order_.size());
    edges.reserve(result_.edges_.size());
    uses.reserve(result_.uses_.size());
    for (const Placed& placed : order_) {
      const std::uint32_t edge = placed.edge;
      number[edge] = static_cast<std::uint32_t>(edges.size());
      edges.push_back({result_.edge(edge).a, result_.edge(edge).b, static_cast<std::uint32_t>(uses.size())});
      const auto own = result_.uses(edge);
      uses.insert(uses.end(), own.begin(), own.end());
    }
    edges.push_back({0, 0, static_cast<std::uint32_t>(uses.size())});
    for (std::uint32_t& edge : result_.edge_of_corner_) edge = number[edge];  // of transparent pieces it is unused
    result_.edges_ = std::move(edges);
    result_.uses_ = std::move(uses);
  }

  [[nodiscard]] Box box_of_edge(std::uint32_t edge) const {
    const Vec3& a = vertices_[result_.edge(edge).a];
    Box box{a, a};
    for (const EdgeUse& use : result_.uses(edge)) {
      for (const std::uint32_t corner : scene_.corners(pieces_[use.piece()])) box.include(vertices_[corner]);
    }
    return box;
  }

  [[nodiscard]] NormalBounds normals_of_edge(std::uint32_t edge) const {
    if (!is_balanced(edge)) return {};
    const auto uses = result_.uses(edge);
    NormalBounds bounds = normals_[uses.front().piece()];
    for (const EdgeUse& use : uses.subspan(1)) include(bounds, normals_[use.piece()]);
    return bounds;
  }

  [[nodiscard]] bool is_balanced(std::uint32_t edge) const {
    int balance = 0;
    for (const EdgeUse& use : result_.uses(edge)) balance += use.upwards() != (turned_[use.piece()] != 0) ? 1 : -1;
    return balance == 0;
  }

  // The middle of an edge. Only the shape of the tree depends on it.
  [[nodiscard]] Vec3 middle(std::uint32_t edge) const {
    const Vec3 &a = vertices_[result_.edge(edge).a], &b = vertices_[result_.edge(edge).b];
    return {0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y, 0.5 * a.z + 0.5 * b.z};
  }

  struct Placed {
    Vec3 middle;
    std::uint32_t edge;
  };

  const Scene& scene_;
  const std::span<const Piece> pieces_;
  const std::span<const Vec3> vertices_;
  SceneEdges& result_;
  std::vector<std::uint8_t> turned_;   // by piece
  std::vector<NormalBounds> normals_;  // by piece, after turning
  std::vector<Placed> order_;          // edges, in the order of the leaves
};

std::span<const std::uint32_t> SceneEdges::of_piece(const Piece& piece) const {
  return {edge_of_corner_.data() + piece.first_corner, piece.corner_count};
}

SceneEdges::SceneEdges(const Scene& scene) { SceneEdgesBuilder(scene, *this).build(); }

const SceneEdges& scene_edges(const Scene& scene) {
  return SceneInside::data(scene).edges.made_by([&] { return SceneEdges(scene); });
}

// --- Connectedness ---

// Two estimates. The first needs no edges. Pieces that share a corner form a *body*. Let it have F pieces with U
// corners in all, at P places. It has U uses of edges and, by Euler's formula, about P + F edges; so about U - P - F of
// these are inside it, with two uses each. Of the m edges inside a body, at least about 2 sqrt(m) are silhouettes, as
// on a sphere, and all others are taken to be.
//
// The second is made only where the first promises much. An edge of two pieces is a silhouette from a far point in a
// random direction with the probability a / pi, a being the angle between their normals: of a box, half of the edges.

namespace {

struct Body {
  double pieces = 0.0, corners = 0.0, places = 0.0;
};

class Bodies {
 public:
  explicit Bodies(const Scene& scene)
      : scene_(scene), places_(places(scene)), parent_(places_.size()), bodies_(places_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    join_corners();
    count();
  }

  // By places; of most there are no pieces.
  [[nodiscard]] const std::vector<Body>& bodies() const { return bodies_; }

 private:
  [[nodiscard]] std::uint32_t root(std::uint32_t place) {
    while (parent_[place] != place) place = parent_[place] = parent_[parent_[place]];
    return place;
  }

  void join_corners() {
    for (const Piece& piece : scene_.pieces()) {
      if (piece.transparent) continue;
      const auto corners = scene_.corners(piece);
      const std::uint32_t first = places_[corners.front()];
      for (const std::uint32_t corner : corners) parent_[root(places_[corner])] = root(first);
    }
  }

  void count() {
    std::vector<bool> used(places_.size());
    for (const Piece& piece : scene_.pieces()) {
      if (piece.transparent) continue;
      const auto corners = scene_.corners(piece);
      Body& body = bodies_[root(places_[corners.front()])];
      body.pieces += 1.0;
      body.corners += static_cast<double>(corners.size());
      for (const std::uint32_t corner : corners) used[places_[corner]] = true;
    }
    for (std::uint32_t place = 0; place < used.size(); ++place) {
      if (used[place]) bodies_[root(place)].places += 1.0;
    }
  }

  const Scene& scene_;
  const std::span<const std::uint32_t> places_;
  std::vector<std::uint32_t> parent_;  // by place
  std::vector<Body> bodies_;
};

double by_bodies(const Scene& scene) {
  double edges = 0.0, silhouettes = 0.0;
  const Bodies bodies(scene);
  for (const Body& body : bodies.bodies()) {
    const double own = body.places + body.pieces, inside = std::max(body.corners - own, 0.0);
    edges += own;
    silhouettes += std::min(own, std::max(own - inside, 0.0) + 2.0 * std::sqrt(inside));
  }
  return silhouettes > 0.0 ? edges / silhouettes : 1.0;
}

Vec3 normal_of(const Scene& scene, const Piece& piece) {
  const auto vertices = scene.vertices();
  const Vec3& p = vertices[piece.frame[0]];
  return kernel::cross(kernel::difference(vertices[piece.frame[1]], p),
                       kernel::difference(vertices[piece.frame[2]], p));
}

double probability(const Scene& scene, std::span<const EdgeUse> uses) {
  if (uses.size() != 2) return 1.0;
  const Vec3 n = normal_of(scene, scene.pieces()[uses[0].piece()]),
             m = normal_of(scene, scene.pieces()[uses[1].piece()]);
  const double sizes = std::hypot(n.x, n.y, n.z) * std::hypot(m.x, m.y, m.z);
  const double cosine = kernel::dot(n, m) / sizes;
  if (!(sizes > 0.0) || !std::isfinite(cosine)) return 1.0;
  const double agreeing = uses[0].upwards() != uses[1].upwards() ? cosine : -cosine;
  return std::acos(std::clamp(agreeing, -1.0, 1.0)) / std::numbers::pi;
}

double by_angles(const Scene& scene) {
  const SceneEdges& edges = scene_edges(scene);
  double silhouettes = 1.0;
  for (std::uint32_t edge = 0; edge < edges.size(); ++edge) silhouettes += probability(scene, edges.uses(edge));
  return static_cast<double>(edges.size()) / silhouettes;
}

double estimated(const Scene& scene) {
  constexpr double kPromising = 3.0;
  const double estimate = by_bodies(scene);
  return estimate < kPromising ? estimate : std::min(estimate, by_angles(scene));
}

}  // namespace

double edges_per_silhouette(const Scene& scene) {
  return SceneInside::data(scene).edges_per_silhouette.made_by([&] { return estimated(scene); });
}

}  // namespace exactff
