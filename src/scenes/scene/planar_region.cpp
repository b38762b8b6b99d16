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
#include <stdexcept>
#include <unordered_map>

#include "kernel/vec.h"
#include "scene/edge_crossing.h"

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

  void insert_points(std::span<const Vec3> vertices, const kernel::ExactVec3& normal);
  Ends ends_of(EdgeIndex edge) const;
  bool insert_edges(PlanarRegion& region);
  void add_steps(EdgeIndex edge);
  void label_triangles(PlanarRegion& region);
  Label across(FaceHandle face, int side) const;
  std::vector<std::vector<std::size_t>> merged_parts();

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

void Builder::insert_points(std::span<const Vec3> vertices, const kernel::ExactVec3& normal) {
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

// Both ends of an edge. The triangulation searches around the first end, so the first is the end that the rings visit
// less.
Builder::Ends Builder::ends_of(EdgeIndex edge) const {
  const std::size_t end = next_in_ring(points_, edge);
  if (visits_[edge] <= visits_[end]) return {handle_[edge], handle_[end], 1};
  return {handle_[end], handle_[edge], -1};
}

bool Builder::insert_edges(PlanarRegion& region) {
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
void Builder::add_steps(EdgeIndex edge) {
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

// The label that the neighbour beyond a side must have.
Label Builder::across(FaceHandle face, int side) const {
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

void Builder::label_triangles(PlanarRegion& region) {
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

std::vector<std::vector<std::size_t>> Builder::merged_parts() {
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

}  // namespace

PlanarRegion planar_region(std::span<const Vec3> vertices, const FacePoints& points, const PlanePoints& plane,
                           const kernel::ExactVec3& normal) {
  return Builder(vertices, points, plane, normal).run();
}

}  // namespace exactff
