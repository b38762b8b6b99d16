// Cells: convex polygons in the receiver's plane, cut exactly.
//
// A corner is the point that the receiver's plane shares with the planes of two sides. Sides are planes of the scene,
// or planes of two or three of its points, so that however often a cell is cut, its numbers do not grow.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/vec.h"
#include "view_factors/polygons.h"

namespace exactff::view_factors {

struct Cell {
  std::vector<Point> corners;                       // counter-clockwise as seen from the receiver's front
  std::vector<std::shared_ptr<const Plane>> sides;  // side i leads from corner i to the next
};

// The sides' planes are positive outside.
[[nodiscard]] Cell cell_of(const Points& points, const Ring& ring, const Plane& receiver);

// The sign that an affine function, zero on the plane, has everywhere inside the cell; 0 if it vanishes there.
// kMixed: it has both signs inside.
inline constexpr int kMixed = 2;
[[nodiscard]] int sign_inside(const Plane& plane, const Cell& cell);

// The same from the function's sign at a corner.
template <class SignAt>
int common_sign(const Cell& cell, const SignAt& sign_at) {
  int found = 0;
  for (const Point& corner : cell.corners) {
    const int sign = sign_at(corner);
    if (sign == 0 || sign == found) continue;
    if (found != 0) return kMixed;
    found = sign;
  }
  return found;
}

// The two parts of a cell. Requires that the plane has both signs inside.
struct Halves {
  Cell negative, positive;
};
[[nodiscard]] Halves cut(const Cell& cell, const Plane& receiver, const std::shared_ptr<const Plane>& by,
                         const Units& units);

// --- Estimates ---

using kernel::length;
[[nodiscard]] double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b);
[[nodiscard]] double distance_from_sides(const Cell& cell, const Vec3& x);
[[nodiscard]] std::vector<Vec3> positions_of(const std::vector<Point>& points);
// Of a planar polygon; in squares of the unit of Point::at.
[[nodiscard]] double area(const std::vector<Vec3>& ring);
[[nodiscard]] inline double area(const Cell& cell) { return area(positions_of(cell.corners)); }
// The smaller of the two parts' areas, over the whole.
[[nodiscard]] double balance(const Cell& cell, const Plane& plane);
// More than that, from an estimate of the plane; 1 if it says nothing.
[[nodiscard]] double balance_at_most(const Cell& cell, const RoundedPlane& plane);
// A plane across the cell, perpendicular to the axis along which it is widest, at a short number near its middle.
[[nodiscard]] std::shared_ptr<const Plane> bisector(const Cell& cell, const Units& units);

}  // namespace exactff::view_factors
