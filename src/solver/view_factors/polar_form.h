// The polar form of a quadratic function at pairs of corners (cell_view.h), in double.
#pragma once

#include <vector>

#include "exactff/geometry.h"

namespace exactff::view_factors {

// Calls visit(b) for the coefficients b(c_i, c_j), i <= j, until one call returns false.
template <class Function, class Visit>
void for_each_coefficient(const Function& f, const std::vector<Vec3>& corners, const Visit& visit) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& y = corners[i];
    const double at_y = f(y);
    if (!visit(at_y)) return;
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      const Vec3& z = corners[j];
      const Vec3 middle{0.5 * (y.x + z.x), 0.5 * (y.y + z.y), 0.5 * (y.z + z.z)};
      if (!visit(2.0 * f(middle) - 0.5 * (at_y + f(z)))) return;
    }
  }
}

}  // namespace exactff::view_factors
