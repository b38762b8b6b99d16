// A patch of a matrix: what all of its factors share, prepared once.
#pragma once

#include <vector>

#include "kernel/disc.h"
#include "view_factors/exact_scene.h"
#include "view_factors/seen_parts.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

struct PreparedPatch {
  // Throws InputError for a patch without area.
  PreparedPatch(const ExactScene& scene, const Selection& patch, bool surrounds_scene);

  Selection selection;
  std::vector<Part> parts;
  double area = 0.0;           // in the scene's unit of length, squared
  double unit_area = 0.0;      // in squares of the unit of Point::at
  kernel::Disc enclosed_area;  // the same
  bool planar = true;          // all of its faces
  bool surrounds;              // whatever meets nothing else meets one of its fronts (Columns::kSurroundings)
  SeenParts::OfPatch seen;
};

}  // namespace exactff::view_factors
