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
  if (!sight.is_of_open()) open_.emplace(corners_of(sight), sight.receiver);
}

double UnhiddenBound::on(std::span<const Vec3> corners) const {
  const double bound = by_distance_.on(corners);
  return open_ ? std::min(bound, open_->on(corners)) : bound;
}

// --- Hidden bound ---

namespace {

std::vector<Vec3> part_behind(const Side& plane, std::span<const Vec3> ring) {
  std::vector<Vec3> part;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double above_a = plane.height(a) - kAside, above_b = plane.height(b) - kAside;
    if (above_a <= 0.0) part.push_back(a);
    if ((above_a <= 0.0) != (above_b <= 0.0)) {
      part.push_back(kernel::along(a, kernel::difference(b, a), above_a / (above_a - above_b)));
    }
  }
  return part;
}

double most_area(const std::vector<Vec3>& part) { return part.empty() ? 0.0 : area(part) + kAside; }

}  // namespace

LowOccluder::LowOccluder(const Side& above, std::span<const Vec3> occluder) {
  for (const Vec3& corner : occluder) {
    height_ = std::max(height_, above.height(corner) + kAside);
    box_.include(corner);
  }
  for (std::size_t i = 0; i < occluder.size(); ++i) {
    const Vec3 along = kernel::difference(occluder[(i + 1) % occluder.size()], occluder[i]);
    const Vec3 across = kernel::cross(along, above.normal);
    if (!(kernel::length(across) > kLeastDistance)) continue;
    const Vec3 outwards = kernel::unit(across);
    for (const Vec3& normal : {outwards, kernel::scaled(outwards, -1.0)}) {
      double farthest = -HUGE_VAL;
      for (const Vec3& corner : occluder) farthest = std::max(farthest, kernel::dot(normal, corner));
      around_.push_back({normal, -farthest});
    }
  }
}

double LowOccluder::hidden_from(std::span<const Vec3> polygon, double size) const {
  Box box;
  double perimeter = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    box.include(polygon[i]);
    perimeter += kernel::distance(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  const double apart = gap(box, box_) - height_ - kAside;
  const double far = apart > 0.0 ? size * height_ * height_ / (4.0 * apart * apart) : HUGE_VAL;
  std::vector<Vec3> covered(polygon.begin(), polygon.end());
  for (const Side& side : around_) covered = part_behind(side, covered);
  return std::min(far, most_area(covered) + (perimeter + kAside) * height_) * kOverRoundings;
}

HiddenBound::HiddenBound(const Sight& sight, const Plane& source_plane, std::span<const Vec3> directions,
                         const Occluder& occluder) {
  const std::vector<Vec3> source = corners_of(sight), root = positions_of(sight.root.corners);
  const double size = area(source), size_of_root = area(root);
  std::vector<Vec3> ring;
  for (const Edge& edge : occluder.ring) ring.push_back(sight.points[edge.from].at);
  const auto try_direction = [&](const Vec3& normal) {
    double highest = -HUGE_VAL;
    for (const Vec3& corner : ring) highest = std::max(highest, kernel::dot(normal, corner));
    const Side plane{normal, -highest};
    const std::vector<Vec3> part = part_behind(plane, source);
    if (most_area(part) > kSmall * size || most_area(part_behind(plane, root)) > kMost * size_of_root) return;
    behind_.push_back({plane, most_area(part), FactorBound(part, source_plane, sight.receiver)});
  };
  for (const Vec3& direction : directions) {
    try_direction(direction);
    try_direction(kernel::scaled(direction, -1.0));
  }
  LowOccluder above_receiver(Side::of(sight.receiver), ring), above_source(Side::of(source_plane), ring);
  if (above_receiver.height() < kLow) above_receiver_ = std::move(above_receiver);
  if (above_source.height() < kLow) from_source_ = above_source.hidden_from(source, size);
  may_be_small_ = !behind_.empty() || above_receiver_ || from_source_ < kSmall * size;
}

double HiddenBound::on(std::span<const Vec3> cell, double most, double size) const {
  double least = from_source_;
  if (above_receiver_) least = std::min(least, above_receiver_->hidden_from(cell, size));
  for (const auto& [plane, area, part] : behind_) {
    const double from_part = most_area(part_behind(plane, cell)) * most;
    if (from_part < least)
      least = std::min(least, from_part + (area > 0.0 ? std::min(area, size * part.on(cell)) : 0.0));
  }
  return least * kOverRoundings;
}

namespace {

std::vector<Vec3> corners_of(const Sight& sight, std::uint32_t occluder) {
  std::vector<Vec3> corners;
  for (const Edge& edge : sight.occluders[occluder].ring) corners.push_back(sight.points[edge.from].at);
  return corners;
}

}  // namespace

CoverBound::CoverBound(const Sight& sight, std::uint32_t inner, std::uint32_t outer, std::optional<Neighbour> neighbour)
    : plane_(Side::of(*sight.occluders[outer].plane)), inner_(corners_of(sight, inner)), behind_(kAside) {
  const std::vector<Vec3> root = positions_of(sight.root.corners);
  const auto highest = [&](std::span<const Vec3> corners) {
    double height = -HUGE_VAL;
    for (const Vec3& corner : corners) height = std::max(height, plane_.height(corner));
    return height;
  };
  if (highest(inner_) > kSmall) plane_ = plane_.opposite();
  if (highest(inner_) > kSmall || highest(root) < kSmall) return;
  std::vector<Vec3> outline = corners_of(sight, outer);
  if (neighbour) {
    std::ranges::rotate(outline, outline.begin() + static_cast<std::ptrdiff_t>(neighbour->side + 1) %
                                                       static_cast<std::ptrdiff_t>(outline.size()));
    std::vector<Vec3> other = corners_of(sight, neighbour->occluder);
    for (std::size_t i = 0; i < other.size(); ++i) {
      const Vec3 &a = other[i], &b = other[(i + 1) % other.size()];
      const double height = std::max(std::abs(plane_.height(a)), std::abs(plane_.height(b))) + kAside;
      behind_ = std::max(behind_, height);
      slivers_.push_back({2.0 * (kernel::distance(a, b) + kAside) * height, {}});
      slivers_.back().box.include(a);
      slivers_.back().box.include(b);
    }
    const auto last = std::ranges::find(other, outline.back());
    if (last == other.end()) return;
    std::ranges::rotate(other, last);
    if (other.back() != outline.front()) std::ranges::reverse(other.begin() + 1, other.end());
    if (other.back() != outline.front()) return;
    outline.insert(outline.end(), other.begin() + 1, other.end() - 1);
  }
  const Side above = plane_.opposite();
  add(part_behind({above.normal, above.offset - behind_}, inner_), 2.0, slivers_);
  take_outline(std::move(outline));
  may_be_small_ = !outwards_.empty() && on({}, 1.0, 1.0) < kSmall;
}

void CoverBound::add(std::span<const Vec3> part, double times, std::vector<Sliver>& slivers) {
  if (part.empty()) return;
  slivers.push_back({times * (area({part.begin(), part.end()}) + kAside), {}});
  for (const Vec3& corner : part) slivers.back().box.include(corner);
}

void CoverBound::take_outline(std::vector<Vec3> outline) {
  std::vector<Vec3> corners;
  const auto merge = [&](const Vec3& corner) {
    slivers_.push_back({2.0 * kernel::distance(corner, corners.back()), {}});
    for (const Vec3& any : outline) slivers_.back().box.include(any);
  };
  for (const Vec3& corner : outline) {
    if (corners.empty() || kernel::distance(corner, corners.back()) > kOneCorner) {
      corners.push_back(corner);
    } else {
      merge(corner);
    }
  }
  if (corners.size() > 1 && kernel::distance(corners.back(), corners.front()) <= kOneCorner) {
    merge(corners.front());
    corners.pop_back();
  }
  if (corners.size() < 3) return;
  Vec3 turn;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    turn = kernel::sum(turn, kernel::cross(kernel::difference(corners[i - 1], corners[0]),
                                           kernel::difference(corners[i], corners[0])));
  }
  const double sense = kernel::dot(turn, plane_.normal) < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const Vec3 across = kernel::cross(kernel::difference(b, a), plane_.normal);
    const Vec3 normal = kernel::unit(kernel::scaled(across, sense));
    outwards_.push_back(normal);
    sides_.push_back(std::min(kernel::dot(normal, a), kernel::dot(normal, b)));
  }
}

// In a square that holds all points of the scene.
std::vector<Vec3> CoverBound::within(std::span<const double> reach) const {
  constexpr double kBeyond = 4.0;
  const Vec3 foot = kernel::scaled(plane_.normal, -plane_.offset);
  const Vec3 aside = std::abs(plane_.normal.x) < 0.6 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 u = kernel::scaled(kernel::unit(kernel::cross(plane_.normal, aside)), kBeyond);
  const Vec3 v = kernel::scaled(kernel::unit(kernel::cross(plane_.normal, u)), kBeyond);
  std::vector<Vec3> part;
  for (const auto& [s, t] : {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0), std::pair(-1.0, 1.0)}) {
    part.push_back(kernel::along(kernel::along(foot, u, s), v, t));
  }
  for (std::size_t i = 0; i < reach.size(); ++i) part = part_behind({outwards_[i], -reach[i]}, part);
  return part;
}

double CoverBound::on(std::span<const Vec3> cell, double most, double size) const {
  std::vector<double> reach(sides_.size(), -HUGE_VAL);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    for (const Vec3& corner : inner_) reach[i] = std::max(reach[i], kernel::dot(outwards_[i], corner));
    for (const Vec3& corner : cell) reach[i] = std::max(reach[i], kernel::dot(outwards_[i], corner));
    if (reach[i] - sides_[i] > kSmall) return HUGE_VAL;
  }
  Box box;
  for (const Vec3& corner : cell) box.include(corner);
  double sum = most_area(part_behind({plane_.normal, plane_.offset - behind_}, cell)) * most;
  const auto count = [&](const std::vector<Sliver>& slivers) {
    for (const Sliver& sliver : slivers) {
      const double apart = gap(box, sliver.box) - behind_ - kAside;
      sum += sliver.area * (apart > 0.0 ? std::min(1.0, size / (std::numbers::pi * apart * apart)) : 1.0);
    }
  };
  count(slivers_);
  std::vector<Sliver> beyond;
  const std::vector<Vec3> reached = within(reach);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    add(part_behind({kernel::scaled(outwards_[i], -1.0), sides_[i] - kAside}, reached), 1.0, beyond);
  }
  count(beyond);
  return sum * kOverRoundings;
}

// --- Strip to the horizon ---

StripBound::StripBound(const Sight& sight, const Ring& ring, const NearHorizon& near, const Plane& plane, Sides sides) {
  const auto& [first, count, in_plane] = near;
  std::vector<Vec3> strip;
  for (std::size_t k = 0; k <= count; ++k) strip.push_back(sight.points[ring[(first + k) % ring.size()].from].at);
  strip.push_back(sight.points[in_plane.to].at);
  strip.push_back(sight.points[in_plane.from].at);
  const Vec3 &end = sight.points[in_plane.from].at, normal = Side::of(sight.receiver).normal;
  along_ = kernel::unit(kernel::difference(sight.points[in_plane.to].at, end));
  const Vec3 across = kernel::cross(normal, along_);
  Plane seen = plane;
  double high = 0.0, wide = 0.0, most = 0.0;
  for (const double side : {1.0, -1.0}) {
    if (side < 0.0 && sides == Sides::kFront) break;
    for (double& coefficient : seen.rounded) coefficient *= side;
    strip_.emplace_back(strip, seen, sight.receiver);
    most = std::max(most, strip_.back().on_plane());
    const double to_cell = kernel::dot(across, Side::of(seen).normal) < 0.0 ? -1.0 : 1.0;
    for (const Vec3& corner : strip) {
      const Vec3 p = kernel::difference(corner, end);
      high = std::max(high, kernel::dot(normal, p) + kAside);
      wide = std::max(wide, to_cell * kernel::dot(across, p) + kAside);
    }
  }
  area_ = static_cast<double>(strip_.size()) * (area(strip) + kAside);
  for_length_ = most * wide + high * std::sqrt(most);
}

double StripBound::on(std::span<const Vec3> cell, double size) const {
  double first = HUGE_VAL, last = -HUGE_VAL;
  for (const Vec3& corner : cell) {
    first = std::min(first, kernel::dot(along_, corner));
    last = std::max(last, kernel::dot(along_, corner));
  }
  double most = 0.0;
  for (const FactorBound& side : strip_) most = std::max(most, side.on(cell));
  return std::min({area_, size * most, (last - first + kAside) * for_length_}) * kOverRoundings;
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
bool reach_before_each_other(const Part& one, const Part& other, const Units& units) {
  const auto reaches_before = [&](const Part& part, const Part& of_plane) {
    const Plane plane = plane_of(of_plane, units);
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
  const Plane plane = plane_of(receiver, scene_.units);
  if (to_.parts.size() <= kMostSources) {
    of->knows_unhidden = true;
    for (const Part& source : to_.parts) {
      if (!reach_before_each_other(receiver, source, scene_.units)) continue;
      of->unhidden.emplace_back(positions_of(source.corners), plane_of(source, scene_.units), plane);
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
