// Scenes of few patches whose view factors are known.
#pragma once

#include "support/test.h"

namespace exactff::validation {

// Squares of this side, `gap` apart, fronts facing: "below" and "above".
inline generate::PlainScene plates(double side, double gap) {
  generate::PlainScene scene;
  add(scene, "below", {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}});
  add(scene, "above", {{0, side, gap}, {side, side, gap}, {side, 0, gap}, {0, 0, gap}});
  return scene;
}

// A square plate between them, centred.
inline generate::PlainScene plates_with_plate(double side, double plate, double height) {
  generate::PlainScene scene = plates(side, 1.0);
  const double low = 0.5 * (side - plate), high = 0.5 * (side + plate);
  add(scene, "plate", {{low, low, height}, {high, low, height}, {high, high, height}, {low, high, height}});
  return scene;
}

inline generate::PlainScene floor_and_wall() {
  generate::PlainScene scene;
  add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(scene, "wall", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  return scene;
}

}  // namespace exactff::validation

namespace exactff {

using validation::floor_and_wall;
using validation::plates;
using validation::plates_with_plate;

}  // namespace exactff
