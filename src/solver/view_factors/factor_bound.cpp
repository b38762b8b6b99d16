#include "view_factors/factor_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

constexpr double kAside = 0x1p-44;
constexpr double kOverRoundings = 1.0 + 0x1p-40;  // more than the roundings of the bound itself

double height_above(const Plane& plane, const Vec3& p) {
  const auto& n = plane.rounded;
  return (n[0] * p.x + n[1] * p.y + n[2] * p.z + n[3]) / std::hypot(n[0], n[1], n[2]);
}

double gap(const Box& a, const Box& b) {
  const auto along = [](double low_a, double high_a, double low_b, double high_b) {
    return std::max({0.0, low_a - high_b, low_b - high_a});
  };
  return std::hypot(along(a.low.x, a.high.x, b.low.x, b.high.x), along(a.low.y, a.high.y, b.low.y, b.high.y),
                    along(a.low.z, a.high.z, b.low.z, b.high.z));
}

std::vector<Vec3> corners_of(const Sight& sight) {
  std::vector<Vec3> corners;
  for (const Edge& edge : sight.source) corners.push_back(sight.points[edge.from].at);
  return corners;
}

}  // namespace

FactorBound::FactorBound(const Sight& sight)
    : FactorBound(corners_of(sight), sight.points.plane_of(sight.source), sight.receiver) {}

FactorBound::FactorBound(std::span<const Vec3> source, const Plane& source_plane, const Plane& receiver)
    : source_plane_(source_plane), area_(area({source.begin(), source.end()})) {
  for (const Vec3& corner : source) {
    source_.include(corner);
    height_ = std::max(height_, height_above(receiver, corner));
  }
}

double FactorBound::on(std::span<const Vec3> corners) const {
  Box box;
  double height = 0.0;
  for (const Vec3& corner : corners) {
    box.include(corner);
    height = std::max(height, height_above(source_plane_, corner));
  }
  const double distance = gap(box, source_) - kAside;
  if (!(distance > 0.0)) return 1.0;
  const auto cosine = [&](double h) { return std::min(1.0, (h + kAside) / distance); };
  const double bound = (area_ + kAside) / (std::numbers::pi * distance * distance) * cosine(height_) * cosine(height);
  return std::min(1.0, bound * kOverRoundings);
}

}  // namespace exactff::view_factors
