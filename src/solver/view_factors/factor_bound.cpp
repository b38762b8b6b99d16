#include "view_factors/factor_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

constexpr double kAside = 0x1p-44;
constexpr double kLeastDistance = 0x1p-10, kAsideOpen = 0x1p-24;
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

// In front of the plane, rounded.
std::vector<Vec3> part_in_front(std::span<const Vec3> ring, const Plane& plane) {
  std::vector<Vec3> part;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double above_a = height_above(plane, a), above_b = height_above(plane, b);
    if (above_a >= 0.0) part.push_back(a);
    if (above_a * above_b < 0.0) {
      part.push_back(kernel::along(a, kernel::difference(b, a), above_a / (above_a - above_b)));
    }
  }
  return part;
}

}  // namespace

FactorBound::FactorBound(const Sight& sight) {
  if (!sight.is_of_open()) *this = {corners_of(sight), sight.points.plane_of(sight.source), sight.receiver};
}

FactorBound::FactorBound(std::span<const Vec3> source, const Plane& source_plane, const Plane& receiver)
    : source_plane_(source_plane), area_(area({source.begin(), source.end()})) {
  for (const Vec3& corner : source) {
    source_.include(corner);
    height_ = std::max(height_, height_above(receiver, corner));
  }
}

double FactorBound::on(std::span<const Vec3> corners) const {
  if (area_ == kAnyArea) return 1.0;
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

OpenFactorBound::OpenFactorBound(std::span<const Vec3> source, const Plane& receiver)
    : source_(part_in_front(source, receiver)),
      normal_(kernel::unit({receiver.rounded[0], receiver.rounded[1], receiver.rounded[2]})) {}

double OpenFactorBound::on(std::span<const Vec3> corners) const {
  Vec3 centre;
  for (const Vec3& corner : corners) centre = kernel::sum(centre, corner);
  centre = kernel::scaled(centre, 1.0 / static_cast<double>(corners.size()));
  double radius = 0.0;
  for (const Vec3& corner : corners) radius = std::max(radius, kernel::distance(corner, centre));
  return std::min(1.0, factor_at(centre) + slope(centre, radius) * radius + kAsideOpen);
}

double OpenFactorBound::slope(const Vec3& x, double radius) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Vec3 &a = source_[i], &b = source_[(i + 1) % source_.size()];
    const double nearest = distance_to_segment(x, a, b) - radius - kAside;
    if (!(nearest > kLeastDistance)) return HUGE_VAL;
    sum += std::min(std::numbers::pi, kernel::distance(a, b) / nearest) / nearest;
  }
  return sum / std::numbers::pi * kOverRoundings;
}

double OpenFactorBound::factor_at(const Vec3& x) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Vec3 p = kernel::difference(source_[i], x), q = kernel::difference(source_[(i + 1) % source_.size()], x);
    const Vec3 across = kernel::cross(p, q);
    const double size = kernel::length(across);
    if (size > 0.0) sum -= std::atan2(size, kernel::dot(p, q)) * kernel::dot(normal_, across) / size;
  }
  return std::clamp(sum / (2.0 * std::numbers::pi), 0.0, 1.0);
}

UnhiddenBound::UnhiddenBound(const Sight& sight) : by_distance_(sight) {
  if (!sight.is_of_open()) open_.emplace(corners_of(sight), sight.receiver);
}

double UnhiddenBound::on(std::span<const Vec3> corners) const {
  const double bound = by_distance_.on(corners);
  return open_ ? std::min(bound, open_->on(corners)) : bound;
}

}  // namespace exactff::view_factors
