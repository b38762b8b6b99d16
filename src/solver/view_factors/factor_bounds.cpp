#include "view_factors/factor_bounds.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "kernel/poll.h"
#include "view_factors/point_factors.h"
#include "view_factors/prepared_patch.h"

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

// --- Slope bound ---

SlopeBound::SlopeBound(const Sight& sight) : of_occluders_(cut(edges_of_occluders(sight))) {
  std::vector<Segment> edges;
  for (const Edge& edge : sight.source) {
    source_.push_back(sight.points[edge.from].at);
    edges.push_back(segment_of(sight, edge));
  }
  of_source_ = cut(edges);
}

SlopeBound::Segment SlopeBound::segment_of(const Sight& sight, const Edge& edge) {
  const Side receiver = Side::of(sight.receiver);
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
      segment.one = Side::of(*before.plane);
      segment.other = Side::of(*occluder.plane);
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

PatchBounds::PatchBounds(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                         const PreparedPatch& to)
    : scene_(scene), seen_(seen), from_(from), to_(to), parts_(from.parts.size()) {}

Span PatchBounds::on(std::size_t part, const Part& fragment, const Tile& tile, bool with_change) {
  const OfPart& bounds = with_change ? with_slopes(part) : of(part);
  Span span{.range = range_on(bounds, corners_of(fragment, tile))};
  if (!with_change) return span;
  const Reach reach = reach_of(fragment, tile);
  const double useful = span.range / kDraws;
  span.change = sum_of(bounds, [&](const SlopeBound& slope) { return slope.change_on(reach, useful); });
  span.change += 2.0 * kRoundedPoints;
  return span;
}

Span PatchBounds::about(std::size_t part, const Vec3& point) {
  const OfPart& bounds = with_slopes(part);
  return {range_on(bounds, {&point, 1}),
          sum_of(bounds, [&](const SlopeBound& slope) { return slope.about(point, 0.0); })};
}

PatchBounds::OfPart& PatchBounds::of(std::size_t part) {
  std::optional<OfPart>& of = parts_[part];
  if (of) return *of;
  of.emplace();
  const Part& receiver = from_.parts[part];
  const Plane& plane = plane_of(scene_, receiver);
  if (to_.parts.size() <= kMostSources) {
    of->knows_unhidden = true;
    for (const Part& source : to_.parts) {
      if (!reach_before_each_other(scene_, receiver, source)) continue;
      of->unhidden.emplace_back(positions_of(source.corners), plane_of(scene_, source), plane);
    }
  }
  return *of;
}

PatchBounds::OfPart& PatchBounds::with_slopes(std::size_t part) {
  OfPart& of = this->of(part);
  if (!std::exchange(of.slopes_asked, true)) add_slopes(part, of);
  return of;
}

void PatchBounds::add_slopes(std::size_t part, OfPart& of) {
  const Part& receiver = from_.parts[part];
  const std::span<const std::uint32_t> occluders = from_.seen.lists(seen_, from_.parts)[part].occluders;
  const std::size_t sources = to_.surrounds() ? 1 : to_.parts.size();
  for (std::size_t s = 0; s < sources; ++s) {
    if (pieces_ > SlopeBound::kMostPieces) return of.slopes.clear();
    kernel::poll();
    const std::optional<Sight> sight = to_.surrounds() ? sight_of_open(scene_, occluders, receiver)
                                                       : sight_of(scene_, occluders, receiver, to_.parts[s]);
    if (!sight) continue;
    of.slopes.emplace_back(*sight);
    pieces_ += of.slopes.back().pieces();
  }
  of.has_slopes = true;
}

double PatchBounds::range_on(const OfPart& of, std::span<const Vec3> corners) const {
  if (!of.knows_unhidden) return 1.0;
  double sum = 0.0;
  for (const UnhiddenBound& bound : of.unhidden) {
    sum += bound.on(corners);
    if (sum >= 1.0) return 1.0;
  }
  return std::min(1.0, sum * kSum);
}

template <class Slope>
double PatchBounds::sum_of(const OfPart& of, const Slope& slope) {
  if (!of.has_slopes) return HUGE_VAL;
  double sum = 0.0;
  for (const SlopeBound& bound : of.slopes) {
    sum += slope(bound);
    if (sum == HUGE_VAL) break;
  }
  return sum * kSum;
}

}  // namespace exactff::view_factors
