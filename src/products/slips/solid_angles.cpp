#include "slips/solid_angles.h"

#include <cmath>

#include "kernel/vec.h"

namespace exactff::slips {
namespace {

using kernel::cross;
using kernel::dot;

double length(const Vec3& v) { return std::hypot(v.x, v.y, v.z); }

// The signed solid angle of a triangle (Van Oosterom and Strackee, 1983).
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = length(a), lb = length(b), lc = length(c);
  return 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

}  // namespace

double solid_angle_of(const Scene& scene, std::span<const std::uint32_t> pieces, const Vec3& point,
                      std::uint64_t& triangles) {
  double sum = 0.0;
  for (const std::uint32_t piece : pieces) {
    const auto corners = scene.corners(scene.pieces()[piece]);
    const auto seen = [&](std::size_t i) { return kernel::difference(scene.vertices()[corners[i]], point); };
    for (std::size_t i = 2; i < corners.size(); ++i) sum += solid_angle(seen(0), seen(i - 1), seen(i));
    triangles += corners.size() - 2;
  }
  return sum;
}

}  // namespace exactff::slips
