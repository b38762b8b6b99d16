#include "slips/sight_lines.h"

#include <algorithm>
#include <cmath>

#include "kernel/vec.h"

namespace exactff::slips {

using kernel::along;
using kernel::cross;
using kernel::difference;
using kernel::dot;
using kernel::unit;

namespace {

constexpr double kSamePlace = 1e-9;  // of the scene's diameter

}  // namespace

SightLines::SightLines(const Scene& scene) : scene_(scene) {
  if (scene.pieces().empty()) return;
  const Vec3 first = scene.vertices()[scene.corners(scene.pieces().front()).front()];
  Box box{first, first};
  for (const Piece& piece : scene.pieces()) {
    normals_.push_back(unit(scene.face(piece.face).newell));
    for (const std::uint32_t corner : scene.corners(piece)) box.include(scene.vertices()[corner]);
  }
  const auto& [low, high] = box;
  diameter_ = kernel::distance(high, low);
  usable_ = diameter_ > 1e-90 && diameter_ < 1e90 && kernel::max_norm(low) < 1e90 && kernel::max_norm(high) < 1e90;
}

std::vector<Vec3> SightLines::points_of(std::uint32_t piece) const {
  constexpr double kNearCorner = 0.9;
  const auto corners = scene_.corners(scene_.pieces()[piece]);
  Vec3 centre;
  for (const std::uint32_t corner : corners) centre = along(centre, scene_.vertices()[corner], 1.0);
  const auto count = static_cast<double>(corners.size());
  centre = {centre.x / count, centre.y / count, centre.z / count};
  std::vector<Vec3> points{centre};
  for (const std::uint32_t corner : corners)
    points.push_back(along(centre, difference(scene_.vertices()[corner], centre), kNearCorner));
  return points;
}

// Nothing if the ray misses the piece, runs along it, or starts on it.
std::optional<double> SightLines::crossing(std::uint32_t piece, const Vec3& from, const Vec3& direction) const {
  const auto corners = scene_.corners(scene_.pieces()[piece]);
  const Vec3& normal = normals_[piece];
  const double height = dot(normal, difference(scene_.vertices()[corners.front()], from));
  const double speed = dot(normal, direction);
  const double t = height / speed;
  if (!(std::abs(height) > kSamePlace * diameter_) || !(t > 0.0) || !std::isfinite(t)) return std::nullopt;
  return is_within_edges(piece, along(from, direction, t)) ? std::optional(t) : std::nullopt;
}

bool SightLines::is_within_edges(std::uint32_t piece, const Vec3& point) const {
  const auto corners = scene_.corners(scene_.pieces()[piece]);
  const Vec3* previous = &scene_.vertices()[corners.back()];
  for (const std::uint32_t corner : corners) {
    const Vec3& next = scene_.vertices()[corner];
    if (dot(normals_[piece], cross(difference(next, *previous), difference(point, *previous))) < 0.0) return false;
    previous = &next;
  }
  return true;
}

bool SightLines::holds(std::uint32_t piece, const Vec3& point) const {
  const Vec3& corner = scene_.vertices()[scene_.corners(scene_.pieces()[piece]).front()];
  return std::abs(dot(normals_[piece], difference(corner, point))) <= kSamePlace * diameter_ &&
         is_within_edges(piece, point);
}

// Calls visit(piece, t) for each piece that the ray meets, in any order.
template <class Visit>
void SightLines::visit_crossings(const Vec3& from, const Vec3& direction, const Visit& visit) const {
  // Two pairs of half-spaces whose boundary planes hold the ray, and the one before its origin.
  const Vec3 axis = std::abs(direction.x) < 0.6 * kernel::max_norm(direction) ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = unit(cross(direction, axis)), v = unit(cross(direction, u));
  const double blur = 1e-12 * diameter_;
  const HalfSpace shaft[] = {
      {u, -blur}, {{-u.x, -u.y, -u.z}, -blur}, {v, -blur}, {{-v.x, -v.y, -v.z}, -blur}, {unit(direction), 0.0}};
  shaft_tree(scene_).query(from, shaft, [&](std::uint32_t piece) {
    if (const std::optional<double> t = crossing(piece, from, direction)) visit(piece, *t);
    return true;
  });
}

std::optional<Hit> SightLines::first_hit(const Vec3& from, const Vec3& direction, double limit) const {
  const double same = kSamePlace * diameter_ / std::sqrt(dot(direction, direction));
  const auto is_before = [&](const Hit& a, const Hit& b) {
    return std::abs(a.distance - b.distance) > same || a.front == b.front ? a.distance < b.distance : a.front;
  };
  std::optional<Hit> first;
  visit_crossings(from, direction, [&](std::uint32_t piece, double t) {
    if (!(t < limit)) return;
    const Hit hit{piece, t, dot(normals_[piece], direction) < 0.0};
    if (!hit.front && scene_.pieces()[piece].transparent) return;
    if (!first || is_before(hit, *first)) first = hit;
  });
  return first;
}

std::vector<Hit> SightLines::hits_in_sight(const Vec3& from, const Vec3& direction, double limit) const {
  const double same = kSamePlace * diameter_ / kernel::length(direction);
  std::vector<Hit> hits;
  double end = limit;
  visit_crossings(from, direction, [&](std::uint32_t piece, double t) {
    if (!(t < end)) return;
    hits.push_back({piece, t, dot(normals_[piece], direction) < 0.0});
    if (!scene_.pieces()[piece].transparent) end = std::min(end, t + same);
  });
  std::erase_if(hits, [&](const Hit& hit) { return !(hit.distance < end); });
  std::ranges::sort(hits, {}, &Hit::distance);
  return hits;
}

std::vector<std::uint32_t> spread(const std::vector<std::uint32_t>& all, std::size_t count) {
  if (all.size() <= count) return all;
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

Vec3 ray_before(const Vec3& normal, int index) {
  const double share = (index + 0.5) / kRaysOfAnOrigin, radius = std::sqrt(share), turn = 2.399963229728653 * index;
  const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = cross(normal, axis), v = cross(normal, u);
  const double scale = radius / std::sqrt(dot(u, u)), up = std::sqrt(1.0 - share);
  const double a = scale * std::cos(turn), b = scale * std::sin(turn);
  return {a * u.x + b * v.x + up * normal.x, a * u.y + b * v.y + up * normal.y, a * u.z + b * v.z + up * normal.z};
}

// --- Solid angles ---

namespace {

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
