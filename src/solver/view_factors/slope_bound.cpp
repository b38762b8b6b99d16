#include "view_factors/slope_bound.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "kernel/vec.h"
#include "view_factors/cell.h"

namespace exactff::view_factors {

SlopeBound::SlopeBound(const Sight& sight) : of_occluders_(cut(edges_of_occluders(sight))) {
  std::vector<Segment> edges;
  for (const Edge& edge : sight.source) {
    source_.push_back(sight.points[edge.from].at);
    edges.push_back(segment_of(sight, edge));
  }
  of_source_ = cut(edges);
}

SlopeBound::Segment SlopeBound::segment_of(const Sight& sight, const Edge& edge) {
  const Side receiver = side_of(sight.receiver);
  const Vec3 &a = sight.points[edge.from].at, &b = sight.points[edge.to].at;
  const double height = std::max({receiver.height(a), receiver.height(b), 0.0}) + kAside;
  return {.a = a, .b = b, .height = height, .one = {}, .other = {}};
}

// Each once, with the planes of two occluders that share it.
std::vector<SlopeBound::Segment> SlopeBound::edges_of_occluders(const Sight& sight) {
  struct Met {
    std::size_t segment, times;
    PointId from;
    const Plane* plane;
  };
  std::vector<Segment> segments;
  std::map<std::pair<PointId, PointId>, Met> met;
  for (const Occluder& occluder : sight.occluders) {
    for (const Edge& edge : occluder.ring) {
      const auto [place, is_new] =
          met.try_emplace(std::minmax(edge.from, edge.to), Met{segments.size(), 0, edge.from, occluder.plane});
      Met& before = place->second;
      ++before.times;
      if (is_new) {
        segments.push_back(segment_of(sight, edge));
        continue;
      }
      Segment& segment = segments[before.segment];
      segment.is_between = before.times == 2 && edge.from != before.from;
      segment.one = side_of(*before.plane);
      segment.other = side_of(*occluder.plane);
    }
  }
  return segments;
}

// Into pieces of at most kLongest.
std::vector<SlopeBound::Segment> SlopeBound::cut(const std::vector<Segment>& segments) {
  std::vector<Segment> pieces;
  for (const Segment& whole : segments) {
    const Vec3 along = kernel::difference(whole.b, whole.a);
    const double count = std::max(1.0, std::ceil(kernel::length(along) / kLongest));
    for (double i = 0.0; i < count; i += 1.0) {
      pieces.push_back(whole);
      if (i > 0.0) pieces.back().a = pieces[pieces.size() - 2].b;
      if (i + 1.0 < count) pieces.back().b = kernel::along(whole.a, along, (i + 1.0) / count);
    }
  }
  return pieces;
}

SlopeBound::Side SlopeBound::side_of(const Plane& plane) {
  const auto& n = plane.rounded;
  const double size = std::hypot(n[0], n[1], n[2]);
  return {{n[0] / size, n[1] / size, n[2] / size}, n[3] / size};
}

bool SlopeBound::is_hidden(const Segment& segment, const Vec3& centre, double radius) {
  if (!segment.is_between) return false;
  const double one = segment.one.height(centre), other = segment.other.height(centre);
  return std::min(std::abs(one), std::abs(other)) > radius + kAside && (one > 0.0) == (other > 0.0);
}

// Through the point and the sides of the source, positive beyond it.
std::vector<SlopeBound::Beside> SlopeBound::planes_beside(const Vec3& centre) const {
  Vec3 middle;
  for (const Vec3& corner : source_) middle = kernel::along(middle, corner, 1.0 / static_cast<double>(source_.size()));
  std::vector<Beside> planes;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Vec3 p = kernel::difference(source_[i], centre),
               q = kernel::difference(source_[(i + 1) % source_.size()], centre), normal = kernel::cross(p, q);
    const double size = kernel::length(normal);
    if (!(size > kThin * kernel::length(p) * kernel::length(q))) continue;
    Side plane{kernel::scaled(normal, 1.0 / size), -kernel::dot(normal, centre) / size};
    if (plane.height(middle) > 0.0) plane = {kernel::scaled(plane.normal, -1.0), -plane.offset};
    double highest = 0.0;
    for (const Vec3& corner : source_) highest = std::max(highest, plane.height(corner));
    planes.push_back({plane, highest});
  }
  return planes;
}

double SlopeBound::slope(const Segment& piece, const Vec3& centre, double radius) {
  const double nearest = distance_to_segment(centre, piece.a, piece.b) - radius - kAside;
  if (!(nearest > kLeastDistance)) return HUGE_VAL;
  const Vec3 p = kernel::difference(piece.a, centre), q = kernel::difference(piece.b, centre);
  const double to_a = kernel::length(p) - radius - kAside, to_b = kernel::length(q) - radius - kAside;
  const double angle = std::atan2(kernel::length(kernel::cross(p, q)), kernel::dot(p, q)) +
                       (radius + kAside) * (1.0 / to_a + 1.0 / to_b);
  return std::min(std::numbers::pi, angle) * std::min(1.0, piece.height / nearest) / nearest;
}

double SlopeBound::about(const Vec3& centre, double radius, double most) const {
  const double largest = most * std::numbers::pi;
  double sum = 0.0;
  for (const Segment& piece : of_source_) sum += slope(piece, centre, radius);
  const std::vector<Beside> planes = planes_beside(centre);
  for (const Segment& piece : of_occluders_) {
    if (!(sum < largest)) return HUGE_VAL;
    const bool is_beyond = std::ranges::any_of(planes, [&](const Beside& beside) {
      return std::min(beside.plane.height(piece.a), beside.plane.height(piece.b)) > beside.highest + radius + kAside;
    });
    if (!is_beyond && !is_hidden(piece, centre, radius)) sum += slope(piece, centre, radius);
  }
  return sum < largest ? sum / std::numbers::pi * kOverRoundings : HUGE_VAL;
}

}  // namespace exactff::view_factors
