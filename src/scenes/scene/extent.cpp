#include "scene/extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/scene_data.h"

namespace exactff {

namespace {

Extent extent_of(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  Extent extent;
  const auto for_each_corner = [&](const auto& take) {
    for (const Piece& piece : scene.pieces()) {
      for (const std::uint32_t v : scene.corners(piece)) take(scene.vertices()[v]);
    }
  };
  for_each_corner([&](const Vec3& p) { extent.largest = std::max(extent.largest, kernel::max_norm(p)); });
  if (extent.largest == 0.0) return extent;
  extent.scale = std::ldexp(1.0, -std::clamp(std::ilogb(extent.largest) + 1, -1022, 1022));
  Box box{{1, 1, 1}, {-1, -1, -1}};
  for_each_corner([&](const Vec3& p) { box.include(kernel::scaled(p, extent.scale)); });
  const Vec3 sides = kernel::difference(box.high, box.low);
  extent.diameter = std::min(std::hypot(sides.x, sides.y, sides.z) / extent.scale, std::numeric_limits<double>::max());
  return extent;
}

}  // namespace

const Extent& extent(const Scene& scene) {
  const SceneInside::Data& data = SceneInside::data(scene);
  std::call_once(data.extent_found, [&] { data.extent = extent_of(scene); });
  return data.extent;
}

}  // namespace exactff
