// 1. The corners become vertices of a constrained Delaunay triangulation (CGAL, exact predicates on rational numbers),
//    the sides constraints. A corner on a side splits it.
// 2. Crossing a part of a side from its right to its left changes the winding number by one. From the outside inwards,
//    neighbour by neighbour, every triangle gets its number. Those with a number other than 0 are inside.
#include "whole_view/triangles.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <unordered_map>

namespace exactff::whole_view {

namespace {

using PlaneKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, PlaneKernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    PlaneKernel, CGAL::Triangulation_face_base_with_info_2<std::optional<int>, PlaneKernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<PlaneKernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Vertex = Triangulation::Vertex_handle;
using Triangle = Triangulation::Face_handle;

class RegionCutter {
 public:
  explicit RegionCutter(std::span<const visibility::Point2> points) : points_(points), vertex_(points.size()) {}

  std::vector<TriangleCorners> run(std::span<const std::vector<std::uint32_t>> loops) {
    for (const auto& loop : loops) {
      for (const std::uint32_t corner : loop) insert(corner);
    }
    for (const auto& loop : loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        triangulation_.insert_constraint(vertex_[loop[k]], vertex_[loop[(k + 1) % loop.size()]]);
      }
    }
    for (const auto& loop : loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) add_steps(loop[k], loop[(k + 1) % loop.size()]);
    }
    label_triangles();
    return inside();
  }

 private:
  // A loop may come back to a corner.
  void insert(std::uint32_t corner) {
    if (vertex_[corner] != Vertex()) return;
    const visibility::Point2& p = points_[corner];
    vertex_[corner] = triangulation_.insert({PlaneKernel::FT(p.u), PlaneKernel::FT(p.v)}, near_);
    vertex_[corner]->info() = corner;
    near_ = vertex_[corner]->face();
  }

  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  }

  // Follows a side over the corners on it. A step is counted for the direction from the lower to the higher corner.
  void add_steps(std::uint32_t from, std::uint32_t to) {
    for (Vertex at = vertex_[from]; at != vertex_[to];) {
      Vertex next;
      Triangle triangle;
      int side = 0;
      if (!triangulation_.includes_edge(at, vertex_[to], next, triangle, side)) {
        throw std::logic_error("a side of a region is missing from its triangulation");
      }
      steps_[key(at->info(), next->info())] += at->info() < next->info() ? 1 : -1;
      at = next;
    }
  }

  // The number beyond a side: the triangle lies to the left of from -> to.
  [[nodiscard]] int across(Triangle triangle, int side) const {
    const Vertex from = triangle->vertex(Triangulation::ccw(side)), to = triangle->vertex(Triangulation::cw(side));
    const int here = *triangle->info();
    if (triangulation_.is_infinite(from) || triangulation_.is_infinite(to)) return here;
    const auto step = steps_.find(key(from->info(), to->info()));
    if (step == steps_.end()) return here;
    return here - (from->info() < to->info() ? step->second : -step->second);
  }

  void label_triangles() {
    std::vector<Triangle> stack = {triangulation_.infinite_face()};
    stack.back()->info() = 0;
    while (!stack.empty()) {
      const Triangle triangle = stack.back();
      stack.pop_back();
      for (int side = 0; side < 3; ++side) {
        const Triangle neighbour = triangle->neighbor(side);
        if (neighbour->info()) continue;
        neighbour->info() = across(triangle, side);
        stack.push_back(neighbour);
      }
    }
  }

  // In an order that does not depend on the triangulation's memory.
  [[nodiscard]] std::vector<TriangleCorners> inside() const {
    std::vector<TriangleCorners> result;
    int all = 0;
    for (const Triangle triangle : triangulation_.finite_face_handles()) {
      const int winding = *triangle->info();
      if (winding == 0) continue;
      if (all == 0) all = winding;
      if (winding != all || std::abs(winding) != 1) throw std::logic_error("the loops of a region do not bound it");
      TriangleCorners corners{};
      for (std::size_t k = 0; k < 3; ++k) corners[k] = triangle->vertex(static_cast<int>(k))->info();
      std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
      result.push_back(corners);
    }
    std::ranges::sort(result);
    return result;
  }

  std::span<const visibility::Point2> points_;
  Triangulation triangulation_;
  std::vector<Vertex> vertex_;  // by point
  Triangle near_;
  std::unordered_map<std::uint64_t, int> steps_;
};

}  // namespace

std::vector<TriangleCorners> triangles_of(std::span<const visibility::Point2> points,
                                          std::span<const std::vector<std::uint32_t>> loops) {
  if (points.size() == 3 && loops.size() == 1) {
    return {visibility::doubled_area(visibility::Polygon2(points.begin(), points.end())) > 0
                ? TriangleCorners{loops[0][0], loops[0][1], loops[0][2]}
                : TriangleCorners{loops[0][0], loops[0][2], loops[0][1]}};
  }
  return RegionCutter(points).run(loops);
}

}  // namespace exactff::whole_view
