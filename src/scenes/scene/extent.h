// The size of a scene: estimates for diagnoses, on which no value depends.
#pragma once

#include "exactff/scene.h"
#include "scene/shaft_tree.h"

namespace exactff {

struct Extent {
  double largest = 0.0;   // coordinate in magnitude
  double diameter = 0.0;  // diagonal of the bounding box, clamped to finite doubles
  double scale = 1.0;     // the power of two that brings the largest coordinate into [1/2, 1)
};

// Of the faces with area. Computed at the first call; safe to call from several threads.
const Extent& extent(const Scene& scene);

}  // namespace exactff
