// The library's own, under the name by which tests know it, and what only tests and tools need.
#pragma once

#include "models/plain_scene.h"

namespace exactff {
namespace generate = models;

namespace models {

// Multiplies every coordinate by `factor`; the normal stays. Exact for powers of two unless a value overflows or
// underflows.
inline void scale(PlainScene& scene, double factor) {
  const auto scaled = [factor](const Vec3& v) { return Vec3{v.x * factor, v.y * factor, v.z * factor}; };
  for (Vec3& vertex : scene.vertices) vertex = scaled(vertex);
  scene.point = scaled(scene.point);
}

}  // namespace models
}  // namespace exactff
