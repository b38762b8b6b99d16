#include <algorithm>
#include <cmath>
#include <limits>

#include "exactff/receiver.h"
#include "kernel/vec.h"
#include "scene/shaft_tree.h"

namespace exactff {

namespace {

// All coordinates are multiplied by this power of two first, so that no difference of large coordinates overflows.
constexpr double kScale = 0x1p-3;

Vec3 scaled_difference(const Vec3& p, const Vec3& q) {
  return {kScale * p.x - kScale * q.x, kScale * p.y - kScale * q.y, kScale * p.z - kScale * q.z};
}

double outside(double value, double low, double high) {
  return std::max({kScale * low - kScale * value, kScale * value - kScale * high, 0.0});
}

double distance_from_plane(const Face& face, const Vec3& from_corner) {
  return std::abs(kernel::dot(kernel::unit(face.newell), from_corner));
}

}  // namespace

double relative_distance_from_face(const Scene& scene, FaceId id, const Vec3& point) {
  const Face& face = scene.face(id);
  if (face.rings.empty() || face.rings.front().empty()) return 0.0;
  const Vec3& first = scene.vertices()[face.rings.front().front()];
  Box box{first, first};
  for (const std::uint32_t v : face.rings.front()) box.include(scene.vertices()[v]);
  const auto& [low, high] = box;
  const Vec3 extent = scaled_difference(high, low);
  const double diagonal = std::hypot(extent.x, extent.y, extent.z);
  const double from_box =
      std::hypot(outside(point.x, low.x, high.x), outside(point.y, low.y, high.y), outside(point.z, low.z, high.z));
  const double distance = std::max(from_box, distance_from_plane(face, scaled_difference(point, first)));
  if (distance == 0.0) return 0.0;
  if (diagonal == 0.0) return std::numeric_limits<double>::infinity();
  return std::max(distance / diagonal - face.out_of_plane, 0.0);
}

}  // namespace exactff
