// Polygon Booleans in exact rational arithmetic. Only this module uses CGAL's polygon sets.
//
// Requires polygons that are counter-clockwise, simple, of positive area, with coordinates of moderate size. They are
// images of convex rings that were clipped, and PlaneFrame ensures the last: the sets fail once a coordinate or a
// difference reaches 2^1024.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernel/filter.h"

namespace exactff::visibility {

// --- Plane frame ---

// Exact coordinates in a source's plane as seen from x.
//
// The plane is { t : m . t = h } relative to x, with m pointing away from x (h > 0). A direction t meets it where
// its multiple has m . t = h, so (p, q) = (t_i, t_j) / (m . t) are affine coordinates of the plane, i and j being
// the axes other than k, the axis of m's largest component. (u, v) maps a bounding box of (p, q) to the unit
// square: CGAL's filters need numbers of moderate size, and affine maps preserve everything that the Booleans test.

template <class Number>
struct PlanePoint {
  Number u;
  Number v;
};
using Point2 = PlanePoint<kernel::Rational>;
using Polygon2 = std::vector<Point2>;

class PlaneFrame {
 public:
  // `front` is the plane's front normal, and x is in front of the plane. The unit square is the bounding box of
  // `rings`, whose directions all meet the plane.
  PlaneFrame(const kernel::ExactVec3& front, std::span<const kernel::Ring> rings);

  [[nodiscard]] Point2 to_plane(const kernel::ExactVec3& direction) const;
  [[nodiscard]] kernel::ExactVec3 to_direction(const Point2& point) const;
  // Counter-clockwise in (u, v) whatever the ring's own orientation.
  [[nodiscard]] Polygon2 to_polygon(const kernel::Ring& ring_from_x) const;
  // True if counter-clockwise in (u, v) is counter-clockwise as x sees it.
  [[nodiscard]] bool keeps_orientation() const { return keeps_orientation_; }
  // i and j.
  [[nodiscard]] std::array<int, 2> axes() const { return {i_, j_}; }
  // The bounding box in (p, q).
  [[nodiscard]] const Point2& low() const { return low_; }
  [[nodiscard]] const Point2& size() const { return size_; }
  // Area in (p, q) of a region of area 1 in (u, v).
  [[nodiscard]] kernel::Rational unit_area() const { return size_.u * size_.v; }

 private:
  [[nodiscard]] Point2 affine(const kernel::ExactVec3& direction) const;  // (p, q)

  kernel::ExactVec3 m_;
  int i_ = 0;
  int j_ = 1;
  int k_ = 2;
  bool keeps_orientation_ = true;
  Point2 low_;
  Point2 size_;
};

// Twice the signed area.
kernel::Rational doubled_area(const Polygon2& polygon);

// --- Polygon sets ---

// A boundary loop without collinear corners, the region to its left: outer loops run counter-clockwise, holes
// clockwise. A loop may touch itself at a corner.
struct RegionLoop {
  Polygon2 corners;
  bool hole = false;
};

// The union of the polygons.
std::vector<RegionLoop> join(std::span<const Polygon2> polygons);

// The union of `source` minus the union of `occluders`, computed by one join of each and one difference.
std::vector<RegionLoop> difference(std::span<const Polygon2> source, std::span<const Polygon2> occluders);

// The convex hull, counter-clockwise, without collinear corners.
Polygon2 convex_hull(std::span<const Polygon2> polygons);

// Twice the area of a region given by its loops.
kernel::Rational doubled_area(std::span<const RegionLoop> loops);

}  // namespace exactff::visibility
