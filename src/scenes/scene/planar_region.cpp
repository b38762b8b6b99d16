// Convex parts of a planar polygon with holes.
//
// 1. Points at one position become one vertex of a constrained Delaunay triangulation (CGAL, exact predicates on
//    the given doubles, one axis dropped); every ring edge becomes a constraint. Vertices on an edge split it.
//    Edges that cross properly make CGAL throw: nothing is ever constructed.
// 2. Each piece of a ring edge adds what crossing it changes: the winding number of the outer ring, the parity of
//    the holes. Edges traversed there and back (keyhole bridges) thereby vanish.
// 3. From the outside inwards, neighbour by neighbour, every triangle gets its winding number and parity.
// 4. Triangles inside are merged across an edge while both ends stay convex (S. Hertel and K. Mehlhorn, "Fast
//    triangulation of the plane with respect to simple polygons", 1985): at most four times the fewest parts.
#include "scene/planar_region.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "kernel/vec.h"

namespace exactff {

using kernel::coordinate;

namespace {

constexpr int kUnknown = -1;

// The position of a triangle relative to the rings.
struct Label {
  int winding = 0;    // of the outer ring
  bool hole = false;  // inside an odd number of hole rings
  bool known = false;
  int id = kUnknown;  // of triangles inside
};

// The change from the right to the left side of an edge that runs from its lower to its higher vertex.
struct Step {
  int winding = 0;
  bool hole = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<Label, Kernel>>;
using Storage = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Storage,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;
using VertexHandle = Triangulation::Vertex_handle;
using FaceHandle = Triangulation::Face_handle;

// In random order (a fixed one) where there are many: an edge then crosses few triangles for any polygon, since earlier
// edges have cut its path (J. Shewchuk and B. Brown, "Fast segment insertion and incremental construction of
// constrained Delaunay triangulations", 2015). In ring order a slanting comb takes quadratic time.
std::vector<EdgeIndex> insertion_order(std::size_t count) {
  constexpr std::size_t kMany = 1000;
  std::vector<EdgeIndex> order(count);
  std::iota(order.begin(), order.end(), EdgeIndex{0});
  if (count < kMany) return order;
  std::mt19937_64 random(1);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

// Half-edges 3 t, 3 t + 1, 3 t + 2 bound triangle t; half-edge h starts at origin[h].
struct HalfEdges {
  std::vector<std::size_t> origin;
  std::vector<std::size_t> next;
  std::vector<std::size_t> previous;
  std::vector<bool> removed;

  explicit HalfEdges(std::size_t triangles)
      : origin(3 * triangles), next(3 * triangles), previous(3 * triangles), removed(3 * triangles, false) {
    for (std::size_t h = 0; h < 3 * triangles; ++h) {
      next[h] = h % 3 == 2 ? h - 2 : h + 1;
      previous[h] = h % 3 == 0 ? h + 2 : h - 1;
    }
  }

  std::size_t target(std::size_t h) const { return origin[next[h]]; }

  // True if removing h and its twin leaves a convex or straight corner at the origin of h. False if only one other edge
  // would be left there, since the part would keep it as a spike: walked to its end and back.
  bool convex_without(const PlanePoints& plane, std::size_t h, std::size_t twin) const {
    if (origin[previous[h]] == target(next[twin])) return false;
    return plane.orientation(origin[previous[h]], origin[h], target(next[twin])) >= 0;
  }

  void remove(std::size_t h, std::size_t twin) {
    link(previous[h], next[twin]);
    link(previous[twin], next[h]);
    removed[h] = removed[twin] = true;
  }

  void link(std::size_t from, std::size_t to) {
    next[from] = to;
    previous[to] = from;
  }
};

std::vector<std::vector<std::size_t>> cycles(const HalfEdges& edges) {
  std::vector<std::vector<std::size_t>> result;
  std::vector<bool> seen = edges.removed;
  for (std::size_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    result.emplace_back();
    for (std::size_t h = first; !seen[h]; h = edges.next[h]) {
      result.back().push_back(edges.origin[h]);
      seen[h] = true;
    }
  }
  return result;
}

class Builder {
 public:
  Builder(std::span<const Vec3> vertices, const FacePoints& points, const PlanePoints& plane,
          const kernel::ExactVec3& normal)
      : points_(points), plane_(plane) {
    insert_points(vertices, normal);
  }

  PlanarRegion run() {
    PlanarRegion region;
    if (!insert_edges(region)) return region;
    for (EdgeIndex edge = 0; edge < points_.size(); ++edge) add_steps(edge);
    label_triangles(region);
    if (region.fault == RegionFault::kNone) region.parts = merged_parts();
    return region;
  }

 private:
  struct Ends {
    VertexHandle from;
    VertexHandle to;
    int direction;  // 1 if the ring runs from `from` to `to`, else -1
  };

  void insert_points(std::span<const Vec3> vertices, const kernel::ExactVec3& normal) {
    const int drop = longest_axis(normal);
    int u = (drop + 1) % 3;
    int v = (drop + 2) % 3;
    if (kernel::sign(normal[drop]) < 0) std::swap(u, v);
    std::vector<std::size_t> order(points_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return plane_.compare(a, b) < 0; });
    std::vector<std::pair<Kernel::Point_2, std::size_t>> positions;
    std::vector<std::size_t> position_of(points_.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i == 0 || plane_.compare(order[i - 1], order[i]) != 0) {
        const Vec3& p = vertices[points_.vertex[order[i]]];
        positions.emplace_back(Kernel::Point_2(coordinate(p, u), coordinate(p, v)), positions.size());
      }
      position_of[order[i]] = positions.size() - 1;
    }
    triangulation_.insert(positions.begin(), positions.end());
    std::vector<VertexHandle> by_position(positions.size());
    for (const VertexHandle vertex : triangulation_.finite_vertex_handles()) by_position[vertex->info()] = vertex;
    std::vector<std::size_t> visits(positions.size());
    for (const std::size_t position : position_of) ++visits[position];
    for (const std::size_t position : position_of) visits_.push_back(visits[position]);
    handle_.resize(points_.size());
    // A vertex now stands for one of the points at its position: the one of lowest index.
    for (std::size_t i = points_.size(); i-- > 0;) {
      handle_[i] = by_position[position_of[i]];
      handle_[i]->info() = i;
    }
  }

  // Both ends of an edge. The triangulation searches around the first end, so the first is the end that the rings visit
  // less.
  Ends ends_of(EdgeIndex edge) const {
    const std::size_t end = next_in_ring(points_, edge);
    if (visits_[edge] <= visits_[end]) return {handle_[edge], handle_[end], 1};
    return {handle_[end], handle_[edge], -1};
  }

  bool insert_edges(PlanarRegion& region) {
    for (const EdgeIndex edge : insertion_order(points_.size())) {
      const Ends ends = ends_of(edge);
      if (ends.from == ends.to) continue;
      try {
        triangulation_.insert_constraint(ends.from, ends.to);
      } catch (const Triangulation::Intersection_of_constraints_exception&) {
        region.fault = RegionFault::kCrossing;
        const auto crossing = find_crossing(points_, plane_);
        if (!crossing) throw std::logic_error("a face crosses itself, but no two of its edges do");
        region.edges = *crossing;
        return false;
      }
    }
    return true;
  }

  // Follows a ring edge over the vertices on it.
  void add_steps(EdgeIndex edge) {
    const bool outer = edge < points_.ring_start[1];
    const Ends ends = ends_of(edge);
    VertexHandle at = ends.from;
    while (at != ends.to) {
      VertexHandle next;
      FaceHandle face;
      int side = 0;
      const bool found = triangulation_.includes_edge(at, ends.to, next, face, side);
      if (!found) throw std::logic_error("an edge of a face is missing from its triangulation");
      Step& step = steps_[key(at, next)];
      if (outer) step.winding += at->info() < next->info() ? ends.direction : -ends.direction;
      if (!outer) step.hole = !step.hole;
      at = next;
    }
  }

  void label_triangles(PlanarRegion& region) {
    std::vector<FaceHandle> stack = {triangulation_.infinite_face()};
    stack.back()->info().known = true;
    while (!stack.empty()) {
      const FaceHandle face = stack.back();
      stack.pop_back();
      for (int side = 0; side < 3; ++side) {
        const FaceHandle neighbour = face->neighbor(side);
        if (neighbour->info().known) continue;
        Label& label = neighbour->info() = across(face, side);
        label.known = true;
        label.id = kUnknown;
        stack.push_back(neighbour);
        if (label.winding != 0) region.encloses_something = true;
        if (label.winding < 0 || label.winding > 1) region.fault = RegionFault::kWinding;
        if (label.winding == 0 && label.hole && region.fault == RegionFault::kNone)
          region.fault = RegionFault::kHoleOutside;
        if (label.winding == 1 && !label.hole && !triangulation_.is_infinite(neighbour)) label.id = inside_count_++;
      }
    }
  }

  // The label that the neighbour beyond a side must have.
  Label across(FaceHandle face, int side) const {
    Label label = face->info();
    const VertexHandle from = face->vertex(Triangulation::ccw(side));
    const VertexHandle to = face->vertex(Triangulation::cw(side));
    if (triangulation_.is_infinite(from) || triangulation_.is_infinite(to)) return label;
    const auto step = steps_.find(key(from, to));
    if (step == steps_.end()) return label;
    // The triangle lies to the left of from -> to, its neighbour to the right.
    label.winding -= from->info() < to->info() ? step->second.winding : -step->second.winding;
    label.hole ^= step->second.hole;
    return label;
  }

  std::vector<std::vector<std::size_t>> merged_parts() {
    HalfEdges edges(static_cast<std::size_t>(inside_count_));
    std::vector<std::pair<std::size_t, std::size_t>> twins;
    for (const FaceHandle face : triangulation_.finite_face_handles()) {
      if (face->info().id == kUnknown) continue;
      for (int side = 0; side < 3; ++side) {
        const std::size_t h = 3 * static_cast<std::size_t>(face->info().id) + static_cast<std::size_t>(side);
        edges.origin[h] = face->vertex(side)->info();
        const int opposite = Triangulation::cw(side);  // half-edge h runs from vertex side to vertex side + 1
        const FaceHandle neighbour = face->neighbor(opposite);
        if (neighbour->info().id <= face->info().id) continue;
        const int back = Triangulation::ccw(neighbour->index(face));
        twins.emplace_back(h, 3 * static_cast<std::size_t>(neighbour->info().id) + static_cast<std::size_t>(back));
      }
    }
    for (const auto& [h, twin] : twins) {
      if (edges.convex_without(plane_, h, twin) && edges.convex_without(plane_, twin, h)) edges.remove(h, twin);
    }
    return cycles(edges);
  }

  static std::uint64_t key(VertexHandle a, VertexHandle b) {
    const auto [low, high] = std::minmax(a->info(), b->info());
    return (static_cast<std::uint64_t>(low) << 32) | high;
  }

  const FacePoints& points_;
  const PlanePoints& plane_;
  Triangulation triangulation_;
  std::vector<VertexHandle> handle_;  // of each point; points at one position share theirs
  std::vector<std::size_t> visits_;   // of the rings to the position of each point
  std::unordered_map<std::uint64_t, Step> steps_;
  int inside_count_ = 0;
};

}  // namespace

PlanarRegion planar_region(std::span<const Vec3> vertices, const FacePoints& points, const PlanePoints& plane,
                           const kernel::ExactVec3& normal) {
  return Builder(vertices, points, plane, normal).run();
}

// --- Edge crossing ---

// Finds out by a sweep whether any two edges cross.
//
// A line sweeps over the plane in the order of positions (by x, then y; so it leans a little and no edge is parallel to
// it). `status_` holds the edges that meet it from bottom to top. The two edges of the crossing that the sweep reaches
// first are neighbours in that order before it is reached. So only neighbours are tested: when an edge begins, it and
// its two neighbours; when one ends, the two that become neighbours. At one position edges end before others begin: an
// edge that touches a crossing from the left then no longer separates the crossing edges.
//
// Contacts that are not proper crossings do no harm: one of the two edges begins or ends there, so their order never
// changes. Edges that overlap on a line are ordered by index.
// Source: M. I. Shamos and D. Hoey, "Geometric intersection problems" (1976).

namespace {

// Points ranked by position; points at one position have one rank.
std::vector<std::size_t> position_ranks(const PlanePoints& plane) {
  std::vector<std::size_t> order(plane.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return plane.compare(a, b) < 0; });
  std::vector<std::size_t> rank(plane.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    rank[order[i]] = rank[order[i - 1]] + (plane.compare(order[i - 1], order[i]) != 0 ? 1 : 0);
  }
  return rank;
}

class Sweep {
 public:
  Sweep(const FacePoints& points, const PlanePoints& plane)
      : plane_(plane), rank_(position_ranks(plane)), status_(Below{this}), place_(points.size(), status_.end()) {
    for (EdgeIndex edge = 0; edge < points.size(); ++edge) add_edge(edge, next_in_ring(points, edge));
    std::sort(events_.begin(), events_.end());
  }

  std::optional<std::pair<EdgeIndex, EdgeIndex>> run() {
    for (const Event& event : events_) {
      if (event.kind == EventKind::kEnd ? end(event.edge) : begin(event.edge)) return crossing_;
    }
    return std::nullopt;
  }

 private:
  enum class EventKind { kEnd, kBegin };  // in the order in which they take place at one position
  struct Event {
    std::size_t rank;
    EventKind kind;
    EdgeIndex edge;
    auto operator<=>(const Event&) const = default;
  };
  struct Edge {
    std::size_t left = 0;
    std::size_t right = 0;
  };
  struct Below {
    const Sweep* sweep;
    bool operator()(EdgeIndex a, EdgeIndex b) const { return sweep->is_below(a, b); }
  };
  using Status = std::set<EdgeIndex, Below>;

  void add_edge(EdgeIndex edge, std::size_t end) {
    edges_.push_back(rank_[edge] < rank_[end] ? Edge{edge, end} : Edge{end, edge});
    if (rank_[edge] == rank_[end]) return;
    events_.push_back({rank_[edges_.back().left], EventKind::kBegin, edge});
    events_.push_back({rank_[edges_.back().right], EventKind::kEnd, edge});
  }

  // The side of edge b's line on which edge a lies next to the sweep line, where a begins no earlier than b.
  int side_of_later(const Edge& a, const Edge& b) const {
    const int at_left = plane_.orientation(b.left, b.right, a.left);
    return at_left != 0 ? at_left : plane_.orientation(b.left, b.right, a.right);
  }

  bool is_below(EdgeIndex a, EdgeIndex b) const {
    const bool a_later = rank_[edges_[a].left] >= rank_[edges_[b].left];
    const int side = a_later ? side_of_later(edges_[a], edges_[b]) : -side_of_later(edges_[b], edges_[a]);
    return side != 0 ? side < 0 : a < b;
  }

  bool begin(EdgeIndex edge) {
    const auto place = status_.insert(edge).first;
    place_[edge] = place;
    const auto above = std::next(place);
    return (place != status_.begin() && cross(*std::prev(place), edge)) ||
           (above != status_.end() && cross(edge, *above));
  }

  bool end(EdgeIndex edge) {
    const auto above = status_.erase(place_[edge]);
    return above != status_.begin() && above != status_.end() && cross(*std::prev(above), *above);
  }

  bool cross(EdgeIndex a, EdgeIndex b) {
    const auto parts = [&](const Edge& e, const Edge& f) {
      return plane_.orientation(e.left, e.right, f.left) * plane_.orientation(e.left, e.right, f.right) < 0;
    };
    if (!parts(edges_[a], edges_[b]) || !parts(edges_[b], edges_[a])) return false;
    crossing_ = std::minmax(a, b);
    return true;
  }

  const PlanePoints& plane_;
  std::vector<std::size_t> rank_;
  std::vector<Edge> edges_;
  std::vector<Event> events_;
  Status status_;
  std::vector<Status::iterator> place_;  // of the edges in status_
  std::pair<EdgeIndex, EdgeIndex> crossing_;
};

}  // namespace

std::optional<std::pair<EdgeIndex, EdgeIndex>> find_crossing(const FacePoints& points, const PlanePoints& plane) {
  return Sweep(points, plane).run();
}

}  // namespace exactff
