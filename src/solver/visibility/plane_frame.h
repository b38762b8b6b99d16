// Exact coordinates in a source's plane as seen from x.
//
// The plane is { t : m . t = h } relative to x, with m pointing away from x (h > 0). A direction t meets it where
// its multiple has m . t = h, so (p, q) = (t_i, t_j) / (m . t) are affine coordinates of the plane, i and j being
// the axes other than k, the axis of m's largest component. (u, v) maps a bounding box of (p, q) to the unit
// square: CGAL's filters need numbers of moderate size, and affine maps preserve everything that the Booleans test.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernel/direction.h"

namespace exactff::visibility {

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

}  // namespace exactff::visibility
