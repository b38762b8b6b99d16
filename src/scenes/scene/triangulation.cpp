// One face, exactly.
//
// 1. Consecutive vertices at one position are dropped (the lowest index stays, so that the start does not matter).
// 2. Corners become integer points relative to the first one; Newell's vector N and everything below is exact.
// 3. All corners on one line: no area. All in one plane: the face keeps its shape, as one convex part or as the
//    convex parts of planar_region.h. Otherwise the rule of ear_clipping.h along N.
// The decisions use the signs of integer determinants; only newell, area and out_of_plane are rounded.
#include "scene/triangulation.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "kernel/expect.h"
#include "kernel/vec.h"
#include "scene/ear_clipping.h"
#include "scene/edge_crossing.h"
#include "scene/face_points.h"
#include "scene/planar_region.h"

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
  void cut();
  void take_triangle();
  void cut_planar(const ExactVec3& normal);
  void cut_region(const PlanePoints& plane);
  void without_newell(const ExactVec3& normal);
  void cut_other();
  bool is_convex(const PlanePoints& plane) const;
  bool leaves_gap(const std::vector<TriangleIndices>& triangles) const;
  void add_part(const PlanePoints& plane, std::span<const std::size_t> corners);
  void report(const PlanarRegion& region);
  void report_crossing(std::pair<EdgeIndex, EdgeIndex> edges);
  std::string edge_text(EdgeIndex edge) const;

  std::span<const Vec3> vertices_;
  FacePoints points_;
  ExactVec3 newell_;  // of the outer ring, twice its area
  Length twice_area_;
  CutFace face_;
};

void FaceCutter::cut() {
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
void FaceCutter::take_triangle() {
  const std::vector<std::uint32_t>& v = points_.vertex;
  face_.parts.push_back({v, {v[0], v[1], v[2]}});
  twice_area_ = length(newell_);
}

void FaceCutter::cut_planar(const ExactVec3& normal) {
  if (is_zero(newell_)) return without_newell(normal);
  const PlanePoints plane(points_, newell_, PlanePoints::Projection::kDropAxis);
  if (!is_convex(plane)) return cut_region(plane);
  std::vector<std::size_t> all(points_.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  add_part(plane, all);
}

// Turns left or goes straight on at every corner, and goes around once: the x direction changes its sign twice.
bool FaceCutter::is_convex(const PlanePoints& plane) const {
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

void FaceCutter::cut_region(const PlanePoints& plane) {
  const PlanarRegion region = planar_region(vertices_, points_, plane, newell_);
  report(region);
  for (const auto& part : region.parts) add_part(plane, part);
  if (!face_.fault && face_.parts.empty()) face_.shape = FaceShape::kZeroArea;  // the holes remove everything
}

// Planar, with corners not on one line: a tree of edges walked there and back, or two lobes of opposite sense.
void FaceCutter::without_newell(const ExactVec3& normal) {
  const PlanePoints plane(points_, normal, PlanePoints::Projection::kDropAxis);
  const PlanarRegion region = planar_region(vertices_, points_, plane, normal);
  if (region.fault == RegionFault::kCrossing) return report(region);
  face_.shape = FaceShape::kZeroArea;
  if (region.encloses_something) {
    face_.fault = {"encloses area, but its Newell vector (area times normal) is zero", "it has no front side",
                   "split it into simple polygons"};
  }
}

void FaceCutter::cut_other() {
  face_.shape = FaceShape::kTriangulated;
  if (points_.ring_count() > 1) {
    face_.fault = {"has holes, but its vertices are not exactly in one plane",
                   "the position of the holes is not defined", "connect the holes to the outer ring, or use triangles"};
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

// True if anything but the ring bounds the triangles in space, not only as seen along the Newell vector.
bool FaceCutter::leaves_gap(const std::vector<TriangleIndices>& triangles) const {
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

void FaceCutter::add_part(const PlanePoints& plane, std::span<const std::size_t> corners) {
  ConvexPart part;
  for (const std::size_t corner : corners) part.corners.push_back(points_.vertex[corner]);
  std::size_t third = 2;
  while (corners.size() > 3 && plane.orientation(corners[0], corners[1], corners[third]) == 0) ++third;
  part.frame = {part.corners[0], part.corners[1], part.corners[third]};
  twice_area_ = twice_area_ + length(newell(points_, corners));
  face_.parts.push_back(std::move(part));
}

std::string FaceCutter::edge_text(EdgeIndex edge) const {
  return std::to_string(points_.vertex[edge] + 1) + "-" +
         std::to_string(points_.vertex[next_in_ring(points_, edge)] + 1);
}

void FaceCutter::report_crossing(std::pair<EdgeIndex, EdgeIndex> edges) {
  const bool holes = edges.second >= points_.ring_start[1];
  face_.fault = {"crosses itself: edge " + edge_text(edges.first) + " and edge " + edge_text(edges.second) +
                     " (vertex numbers) intersect",
                 holes ? "a hole must lie inside its face" : "its interior is ambiguous",
                 "split it into simple polygons"};
}

void FaceCutter::report(const PlanarRegion& region) {
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

}  // namespace

CutFace cut_face(std::span<const Vec3> vertices, const std::vector<Ring>& rings) {
  EXACTFF_EXPECT(std::ranges::all_of(rings, [&](const Ring& ring) {
    return std::ranges::all_of(ring,
                               [&](std::uint32_t v) { return v < vertices.size() && kernel::is_finite(vertices[v]); });
  }));
  return FaceCutter(vertices, rings).run();
}

}  // namespace exactff
