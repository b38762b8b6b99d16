// An upper bound of form factors, by distance and slope alone.
//
// F(x -> j) is at most the integral of cos cos / (pi r^2) over j. Let no point of the source be nearer to the cell than
// d, none higher above the receiver's plane than h, and no point of the cell higher above the source's plane than k.
// Then the cosines are at most h / d and k / d, and
//
//   F <= A_j / (pi d^2) * min(1, h / d) * min(1, k / d)
//
// from every point of the cell. Coordinates are at most 1 and rounded once, so the distance of two boxes, a height and
// an area are computed to within 2^-46; each is moved by kAside to the safe side.
#pragma once

#include <span>

#include "view_factors/cell.h"
#include "view_factors/exact_scene.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

class FactorBound {
 public:
  explicit FactorBound(const Sight& sight);
  // Of the convex source in this plane, for points in the receiver's plane.
  FactorBound(std::span<const Vec3> source, const Plane& source_plane, const Plane& receiver);

  // At least F(x -> j) for every point x of the cell, or of the convex hull of corners in the receiver's plane; at most
  // 1.
  [[nodiscard]] double on(const Cell& cell) const { return on(positions_of(cell.corners)); }
  [[nodiscard]] double on(std::span<const Vec3> corners) const;

 private:
  Plane source_plane_;
  Box source_;
  double area_ = 0.0, height_ = 0.0;  // of the source; above the receiver's plane
};

}  // namespace exactff::view_factors
