#include "view_factors/factor_bounds.h"

#include <algorithm>
#include <numbers>

#include "view_factors/prepared_patch.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

constexpr double kAside = 0x1p-44;
constexpr double kLeastDistance = 0x1p-10, kAsideOpen = 0x1p-24;
constexpr double kOverRoundings = 1.0 + 0x1p-40;  // more than the roundings of the bound itself

double height_above(const Plane& plane, const Vec3& p) {
  const auto& n = plane.rounded;
  return (n[0] * p.x + n[1] * p.y + n[2] * p.z + n[3]) / std::hypot(n[0], n[1], n[2]);
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
  if (!sight.is_of_open()) *this = {sight.points.positions(sight.source), sight.source_plane, sight.receiver};
}

FactorBound::FactorBound(std::span<const Vec3> source, const Plane& source_plane, const Plane& receiver)
    : source_plane_(Side::of(source_plane)), area_(area({source.begin(), source.end()})) {
  for (const Vec3& corner : source) {
    source_.include(corner);
    height_ = std::max(height_, height_above(receiver, corner));
  }
  constexpr double kOfNormal = 0x1p-49;
  const double apart = kernel::distance(Side::of(source_plane).normal, Side::of(receiver).normal) + kOfNormal;
  lune_ = 0.25 * apart * apart * kOverRoundings;
}

double FactorBound::on(std::span<const Vec3> corners) const {
  if (area_ == kAnyArea) return 1.0;
  Box box;
  double height = 0.0;
  for (const Vec3& corner : corners) {
    box.include(corner);
    height = std::max(height, source_plane_.height(corner));
  }
  const double distance = gap(box, source_) - kAside;
  const double most = on_plane();
  if (!(distance > 0.0)) return most;
  const auto cosine = [&](double h) { return std::min(1.0, (h + kAside) / distance); };
  const double bound = (area_ + kAside) / (std::numbers::pi * distance * distance) * cosine(height_) * cosine(height);
  return std::min(most, bound * kOverRoundings);
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
  if (!sight.is_of_open()) open_.emplace(sight.points.positions(sight.source), sight.receiver);
}

double UnhiddenBound::on(std::span<const Vec3> corners) const {
  const double bound = by_distance_.on(corners);
  return open_ ? std::min(bound, open_->on(corners)) : bound;
}

// --- Patch bounds ---

namespace {

constexpr std::size_t kMostSources = 256;  // of more parts, F is only known to be at most 1
constexpr double kSum = 1.0 + 0x1p-40;     // more than the roundings of a sum

// Otherwise no point of either sees the other.
bool reach_before_each_other(const ExactScene& scene, const Part& one, const Part& other) {
  const auto reaches_before = [&](const Part& part, const Part& of_plane) {
    const Plane& plane = plane_of(scene, of_plane);
    return std::ranges::any_of(part.corners, [&](const Point& corner) { return side_of(plane, corner) > 0; });
  };
  return reaches_before(one, other) && reaches_before(other, one);
}

}  // namespace

PatchBounds::PatchBounds(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to)
    : scene_(scene), from_(from), to_(to), parts_(from.parts.size()) {}

const std::vector<UnhiddenBound>& PatchBounds::of(std::size_t part) {
  std::optional<std::vector<UnhiddenBound>>& bounds = parts_[part];
  if (bounds) return *bounds;
  bounds.emplace();
  const Part& receiver = from_.parts[part];
  for (const Part& source : to_.parts) {
    if (reach_before_each_other(scene_, receiver, source))
      bounds->emplace_back(positions_of(source.corners), plane_of(scene_, source), plane_of(scene_, receiver));
  }
  return *bounds;
}

double PatchBounds::on(std::size_t part, std::span<const Vec3> corners) {
  if (to_.parts.size() > kMostSources) return 1.0;
  double sum = 0.0;
  for (const UnhiddenBound& bound : of(part)) {
    sum += bound.on(corners);
    if (sum >= 1.0) return 1.0;
  }
  return std::min(1.0, sum * kSum);
}

double PatchBounds::mean() {
  const Strata strata = strata_of(from_.parts, kFewestStrata);
  double sum = 0.0;
  for (const Stratum& stratum : strata.strata) {
    const Tile& tile = strata.tiles[stratum.begin];
    const Vec3 middle = sides_of(from_.parts[tile.part], tile).at(middle_of(tile));
    sum += stratum.area / strata.area * on(tile.part, {&middle, 1});
  }
  return std::min(1.0, sum);
}

}  // namespace exactff::view_factors
