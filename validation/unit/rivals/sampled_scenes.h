// Small scenes for the tests of the sampled module.
#pragma once

#include "support/test.h"

namespace exactff::validation {

// The square [-h, h]^2 at height z, facing down.
inline std::vector<Vec3> square_above(double h, double z) { return {{-h, -h, z}, {-h, h, z}, {h, h, z}, {h, -h, z}}; }

// The origin looking up at [-1, 1]^2 at z = 1.
inline generate::PlainScene open_scene() {
  generate::PlainScene scene;
  add(scene, "source", square_above(1.0, 1.0));
  return scene;
}

// The same with the occluder [-h, h]^2 at z = 1/2.
inline generate::PlainScene occluded_scene(double h) {
  generate::PlainScene scene = open_scene();
  add(scene, "occluder", square_above(h, 0.5));
  return scene;
}

}  // namespace exactff::validation
