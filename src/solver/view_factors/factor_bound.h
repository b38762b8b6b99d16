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

#include "view_factors/cell.h"
#include "view_factors/exact_scene.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

class FactorBound {
 public:
  explicit FactorBound(const Sight& sight);

  // At least F(x -> j) for every point x of the cell; at most 1.
  [[nodiscard]] double on(const Cell& cell) const;

 private:
  Plane source_plane_;
  Box source_;
  double area_ = 0.0, height_ = 0.0;  // of the source; above the receiver's plane
};

}  // namespace exactff::view_factors
