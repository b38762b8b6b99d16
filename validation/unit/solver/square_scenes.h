// Square sources above the receiver, and squares in between, for the tests of the exact method.
#pragma once

#include <string>

#include "generate/plain_scene.h"

namespace exactff::validation {

inline generate::PlainScene square_source(double half = 1.0, double z = 1.0) {
  generate::PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-half, half, z}, {half, half, z}, {half, -half, z}, {-half, -half, z}});
  return scene;
}

inline void add_square(generate::PlainScene& scene, const std::string& name, double half, double z, double x = 0.0,
                       double y = 0.0) {
  scene.add_ring(scene.patch(name),
                 {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}});
}

}  // namespace exactff::validation
