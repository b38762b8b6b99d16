// Regions in space: exact corners in the plane of each region (visibility/polygon_sets.h) give its area and its
// triangles, and their points are rounded once.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exact/source_planes.h"
#include "exactff/view.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "scene/scene.h"
#include "visibility/polygon_sets.h"
#include "whole_view/regions.h"

namespace exactff {
namespace {

using kernel::ExactVec3;
using visibility::Point2;
using whole_view::OutlineId;
using whole_view::Region;
using whole_view::Regions;
using whole_view::SideLoop;
using whole_view::ViewEdges;

// --- Triangles ---

// The triangles of a plane region with holes.

using TriangleCorners = std::array<std::uint32_t, 3>;  // indices of points

// 1. The corners become vertices of a constrained Delaunay triangulation (CGAL, exact predicates on rational numbers),
//    the sides constraints. A corner on a side splits it.
// 2. Crossing a part of a side from its right to its left changes the winding number by one. From the outside inwards,
//    neighbour by neighbour, every triangle gets its number. Those with a number other than 0 are inside.

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

// A constrained Delaunay triangulation of the region that the loops have on one side. Exact: no point is added.
// Requires distinct points, sides that do not cross, and a region that is on the left of all loops or on the right of
// all, as the loops of a Region are. Triangles run counter-clockwise. Where four corners lie on a circle, the order of
// the loops decides.
std::vector<TriangleCorners> triangles_of(std::span<const visibility::Point2> points,
                                          std::span<const std::vector<std::uint32_t>> loops) {
  if (points.size() == 3 && loops.size() == 1) {
    return {visibility::doubled_area(visibility::Polygon2(points.begin(), points.end())) > 0
                ? TriangleCorners{loops[0][0], loops[0][1], loops[0][2]}
                : TriangleCorners{loops[0][0], loops[0][2], loops[0][1]}};
  }
  return RegionCutter(points).run(loops);
}

// --- The mesh ---

// --- The region of one face ---

// Twice the area of a face, or of one triangle of it, in the frame.
kernel::Rational doubled_area_of(std::span<const Piece> pieces, const visibility::View& view,
                                 const visibility::PlaneFrame& frame) {
  kernel::Rational sum;
  for (const Piece& piece : pieces) {
    visibility::Polygon2 polygon;
    for (const std::uint32_t corner : view.scene.corners(piece)) {
      polygon.push_back(frame.to_plane(kernel::exact_difference(view.scene.vertices()[corner], view.x).v));
    }
    sum += visibility::doubled_area(polygon);
  }
  return sum;
}

// The corners of a region, each once, and its loops as indices of them.
struct Corners {
  std::vector<const kernel::Direction*> directions;
  std::vector<std::vector<std::uint32_t>> loops;
};

Corners corners_of(const Region& region, const Regions& regions) {
  Corners result;
  std::map<std::uint32_t, std::uint32_t> index;
  for (const SideLoop& loop : region.loops) {
    result.loops.emplace_back();
    for (const whole_view::Side& side : loop) {
      const auto [at, is_new] = index.try_emplace(side.from, static_cast<std::uint32_t>(result.directions.size()));
      if (is_new) result.directions.push_back(&regions.corner(side.from));
      result.loops.back().push_back(at->second);
    }
  }
  return result;
}

class MeshMaker {
 public:
  MeshMaker(const Scene& scene, const Receiver& receiver) : scene_(scene), view_(scene, receiver) {
    edges_.find(view_, ViewEdges::Wholes::kPlanes);
  }

  VisibilityMesh run() {
    const Regions regions(edges_, view_.normal().exact, [&](OutlineId o) { return edges_.whole(o); });
    std::map<std::uint32_t, OutlineId> outline_of;
    for (OutlineId o = 0; o < edges_.outline_count(); ++o) outline_of.try_emplace(edges_.whole(o), o);
    std::vector<std::pair<OutlineId, const Region*>> by_face;
    for (const Region& region : regions.regions()) {
      if (region.thing != Regions::kOpen) by_face.emplace_back(outline_of.at(region.thing), &region);
    }
    std::ranges::stable_sort(by_face, {}, [&](const auto& one) { return edges_.face(one.first); });
    for (const auto& [outline, region] : by_face) {
      kernel::poll();
      add(outline, corners_of(*region, regions));
    }
    return std::move(mesh_);
  }

 private:
  void add(OutlineId outline, const Corners& corners) {
    const Piece& seen = edges_.piece(outline);
    const Face& face = scene_.face(seen.face);
    const bool planar = face.shape != FaceShape::kTriangulated;
    const bool front = edges_.shows_front(outline);
    const auto pieces = planar ? scene_.pieces_of(seen.face) : std::span(&seen, 1);
    const auto triangle = static_cast<std::uint32_t>(&seen - &scene_.pieces()[face.first_piece]) + 1U;

    const auto vertices = scene_.vertices();
    const auto side = [&](int k) {
      return kernel::exact_difference(vertices[seen.frame[k]], vertices[seen.frame[0]]).v;
    };
    ExactVec3 towards_x = cross(side(1), side(2));
    if (!front) kernel::negate(towards_x);
    kernel::Ring ring;
    for (const kernel::Direction* corner : corners.directions) ring.push_back(*corner);
    const visibility::PlaneFrame frame(towards_x, std::span(&ring, 1));
    std::vector<Point2> points;
    for (const kernel::Direction& corner : ring) points.push_back(frame.to_plane(corner.exact));

    const auto triangles = triangles_of(points, corners.loops);
    mesh_.regions.push_back(
        {.face = seen.face,
         .triangle = planar ? 0U : triangle,
         .front = front,
         .fraction = kernel::to_string(fraction_of(triangles, points, doubled_area_of(pieces, view_, frame)))});
    const exact::Lift lift(towards_x, vertices[seen.frame[0]], view_.x);
    std::vector<std::uint32_t> placed;
    for (const kernel::Direction& corner : ring) placed.push_back(point_at(lift(corner.exact)));
    // Counter-clockwise in the frame is so as seen from x if it keeps the orientation; a back is seen from behind.
    if (!front) kernel::negate(towards_x);
    add_triangles(triangles, placed, frame.keeps_orientation() == front, towards_x);
  }

  [[nodiscard]] static kernel::Rational fraction_of(std::span<const TriangleCorners> triangles,
                                                    std::span<const Point2> points, const kernel::Rational& whole) {
    kernel::Rational sum;
    for (const auto& [a, b, c] : triangles) sum += visibility::doubled_area({points[a], points[b], points[c]});
    return sum / abs(whole);
  }

  std::uint32_t point_at(const Vec3& p) {
    const auto [at, is_new] =
        point_at_.try_emplace(std::tuple(p.x, p.y, p.z), static_cast<std::uint32_t>(mesh_.points.size()));
    if (is_new) mesh_.points.push_back(p);
    return at->second;
  }

  void add_triangles(std::span<const TriangleCorners> triangles, std::span<const std::uint32_t> placed, bool keep,
                     const ExactVec3& normal) {
    const auto region = static_cast<std::uint32_t>(mesh_.regions.size() - 1);
    for (const auto& [a, b, c] : triangles) {
      const std::array<std::uint32_t, 3> corners{placed[a], placed[keep ? b : c], placed[keep ? c : b]};
      const auto& [p, q, r] = corners;
      const ExactVec3 side = kernel::exact_difference(mesh_.points[q], mesh_.points[p]).v,
                      other = kernel::exact_difference(mesh_.points[r], mesh_.points[p]).v;
      if (sgn(dot(normal, cross(side, other))) > 0) {
        mesh_.triangles.push_back({region, corners});
      } else {
        ++mesh_.flat;
      }
    }
  }

  const Scene& scene_;
  const visibility::View view_;
  ViewEdges edges_;
  VisibilityMesh mesh_;
  std::map<std::tuple<double, double, double>, std::uint32_t> point_at_;
};

}  // namespace

VisibilityMesh visibility_mesh(const Scene& scene, const Receiver& receiver) {
  const kernel::StandardArithmetic arithmetic;
  exact::check_view_arguments(scene, receiver, {}, 1);
  return MeshMaker(scene, receiver).run();
}

Scene to_scene(const Scene& scene, const VisibilityMesh& mesh) {
  SceneBuilder builder;
  for (const Vec3& point : mesh.points) builder.add_vertex(point);
  for (const Material& material : scene.materials()) builder.add_material(material);
  for (const VisibilityMesh::Triangle& triangle : mesh.triangles) {
    const SeenRegion& region = mesh.regions[triangle.region];
    const Face& face = scene.face(region.face);
    std::string name = scene.patch(face.patch).name;
    if (!region.front) name += " (back)";
    builder.add_face(builder.patch(name), face.material,
                     {std::vector<std::uint32_t>(triangle.corners.begin(), triangle.corners.end())});
  }
  return builder.build();
}

}  // namespace exactff
