// The shaft between two boxes (Haines and Wallace): half-spaces that hold their hull, found in each pair of axes. What
// lies outside one of them does not lie between the boxes.
#pragma once

#include <array>
#include <vector>

#include "view_factors/exact_scene.h"

namespace exactff::view_factors {

class PairShaft {
 public:
  PairShaft(const Box& a, const Box& b);

  // Certainly: no coordinate exceeds 1, and the margin is larger than all roundings.
  [[nodiscard]] bool is_outside(const Box& box) const;

 private:
  // The points with normal[0] (y_first - origin[0]) + normal[1] (y_second - origin[1]) <= limit.
  struct HalfSpace {
    int first, second;  // axes
    std::array<double, 2> normal, origin;
    double limit;
  };
  // Of a product of the normal with points of the box; the least if `sign` is -1, the largest if it is 1.
  [[nodiscard]] static double extreme(const HalfSpace& half_space, const Box& box, int sign);

  std::vector<HalfSpace> half_spaces_;
};

}  // namespace exactff::view_factors
