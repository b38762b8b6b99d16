// The visible fraction of a source in several planes, correctly rounded.
#pragma once

#include <span>

#include "kernel/exact_vec.h"

namespace exactff::exact {

// One plane: its area is projected_area * |normal| / |normal[axis]|, irrational in general.
struct PlaneShare {
  kernel::Rational fraction;        // visible over whole, in [0, 1]
  kernel::Rational projected_area;  // > 0
  kernel::ExactVec3 normal;
  int axis = 0;
};

// Sum of fraction * area over the sum of areas, rounded to the nearest double, ties to even. Requires at least one
// plane.
double visible_fraction(std::span<const PlaneShare> planes);

}  // namespace exactff::exact
