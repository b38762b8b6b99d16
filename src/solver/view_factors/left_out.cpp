#include "view_factors/left_out.h"

#include <algorithm>
#include <iterator>
#include <numbers>

namespace exactff::view_factors {
namespace {

constexpr double kOfHeight = 0x1p-44;
constexpr double kShortest = 0x1p-10;                            // of sides that tell a direction
constexpr double kOfBounds = 1.0 + 0x1p-40;                      // more than the roundings of a bound itself
constexpr double kNearMiss = 0x1p-10, kRoundedHeight = 0x1p-44;  // of a corner and a plane
constexpr std::size_t kMostToMiss = 256;                         // occluders whose planes are looked at
constexpr std::size_t kMostToCover = 64;                         // occluders of which one may cover another
constexpr std::size_t kMostDirections = 16;
constexpr double kSameDirection = 0x1p-30;
constexpr int kHalvings = 8;  // of slivers

}  // namespace

// --- Hidden bound ---

namespace {

std::vector<Vec3> part_behind(const Side& plane, std::span<const Vec3> ring) {
  std::vector<Vec3> part;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double above_a = plane.height(a) - kOfHeight, above_b = plane.height(b) - kOfHeight;
    if (above_a <= 0.0) part.push_back(a);
    if ((above_a <= 0.0) != (above_b <= 0.0)) {
      part.push_back(kernel::along(a, kernel::difference(b, a), above_a / (above_a - above_b)));
    }
  }
  return part;
}

double most_area(const std::vector<Vec3>& part) { return part.empty() ? 0.0 : area(part) + kOfHeight; }

}  // namespace

LowOccluder::LowOccluder(const Side& above, std::span<const Vec3> occluder) : above_(above) {
  for (const Vec3& corner : occluder) height_ = std::max(height_, above.height(corner) + kOfHeight);
  for (std::size_t i = 0; i < occluder.size(); ++i) {
    const Vec3 along = kernel::difference(occluder[(i + 1) % occluder.size()], occluder[i]);
    const Vec3 across = kernel::cross(along, above.normal);
    if (!(kernel::length(across) > kShortest)) continue;
    const Vec3 outwards = kernel::unit(across);
    for (const Vec3& normal : {outwards, kernel::scaled(outwards, -1.0)}) {
      double farthest = -HUGE_VAL;
      for (const Vec3& corner : occluder) farthest = std::max(farthest, kernel::dot(normal, corner));
      around_.push_back({normal, -farthest});
    }
  }
}

double LowOccluder::hidden_from(std::span<const Vec3> polygon, std::span<const Vec3> target,
                                const FactorBound& of_target) const {
  double rise = HUGE_VAL, farthest = 0.0;  // of the target
  for (const Vec3& corner : target) {
    rise = std::min(rise, above_.height(corner) - kOfHeight);
    for (const Vec3& x : polygon) farthest = std::max(farthest, kernel::distance(x, corner) + kOfHeight);
  }
  const double reach = rise > 0.0 ? height_ * farthest / rise : HUGE_VAL;
  double least = HUGE_VAL, around = 0.0;
  std::vector<Vec3> covered(polygon.begin(), polygon.end());
  for (std::size_t i = 0; i < around_.size(); ++i) {
    const Side& line = around_[i];
    const Vec3 along = kernel::cross(line.normal, above_.normal);
    double first = HUGE_VAL, last = -HUGE_VAL, left = HUGE_VAL, right = -HUGE_VAL;
    for (const Vec3& x : polygon) {
      const double out = line.height(x), aside = kernel::dot(along, x);
      first = std::min(first, out), last = std::max(last, out);
      left = std::min(left, aside), right = std::max(right, aside);
    }
    const double width = right - left + kOfHeight, until = std::min(reach, std::max(kNear, first));
    const std::vector<Vec3> near = part_behind({line.normal, line.offset - until}, polygon);
    const double most = near.empty() ? 0.0 : of_target.on(near), end = std::min(reach, last + kOfHeight);
    const double far = end > until ? width * height_ * height_ / 4.0 * (1.0 / until - 1.0 / end) : 0.0;
    const double outside = width * height_ * std::sqrt(most);
    least =
        std::min(least, std::min(most_area(near) * most, most_area(part_behind(line, polygon)) * most + outside) + far);
    if (i % 2 != 0) continue;
    covered = part_behind(line, covered);
    around += outside + far;
  }
  return std::min(least, covered.empty() ? around : most_area(covered) * of_target.on(covered) + around) * kOfBounds;
}

HiddenBound::HiddenBound(const Sight& sight, const Plane& source_plane, std::span<const Vec3> directions,
                         const Occluder& occluder)
    : receiver_(sight.receiver),
      source_plane_(source_plane),
      source_(sight.points.positions(sight.source)),
      of_source_(source_, source_plane, sight.receiver) {
  const std::vector<Vec3> root = positions_of(sight.root.corners);
  const double size = area(source_), size_of_root = area(root);
  const std::vector<Vec3> ring = sight.points.positions(occluder.ring);
  const auto try_direction = [&](const Vec3& normal) {
    double highest = -HUGE_VAL;
    for (const Vec3& corner : ring) highest = std::max(highest, kernel::dot(normal, corner));
    const Side plane{normal, -highest};
    const std::vector<Vec3> part = part_behind(plane, source_);
    if (most_area(part) > kSmall * size || most_area(part_behind(plane, root)) > kMost * size_of_root) return;
    behind_.push_back({plane, most_area(part), FactorBound(part, source_plane, sight.receiver)});
  };
  for (const Vec3& direction : directions) {
    try_direction(direction);
    try_direction(kernel::scaled(direction, -1.0));
  }
  LowOccluder above_receiver(Side::of(sight.receiver), ring), above_source(Side::of(source_plane), ring);
  if (above_receiver.height() < kLow) above_receiver_ = std::move(above_receiver);
  if (above_source.height() < kLow) above_source_ = std::move(above_source);
  may_be_small_ = !behind_.empty() || above_receiver_ || above_source_;
}

double HiddenBound::on(std::span<const Vec3> cell, double most, double size) const {
  double least = HUGE_VAL;
  if (above_receiver_) least = above_receiver_->hidden_from(cell, source_, of_source_);
  if (above_source_) {
    least = std::min(least, above_source_->hidden_from(source_, cell, {cell, receiver_, source_plane_}));
  }
  for (const auto& [plane, area, part] : behind_) {
    const double from_part = most_area(part_behind(plane, cell)) * most;
    if (from_part < least)
      least = std::min(least, from_part + (area > 0.0 ? std::min(area, size * part.on(cell)) : 0.0));
  }
  return least * kOfBounds;
}

CoverBound::CoverBound(const Sight& sight, std::uint32_t inner, std::uint32_t outer, std::optional<Neighbour> neighbour)
    : plane_(Side::of(*sight.occluders[outer].plane)),
      inner_(sight.points.positions(sight.occluders[inner].ring)),
      receiver_(Side::of(sight.receiver)),
      behind_(kOfHeight) {
  const std::vector<Vec3> root = positions_of(sight.root.corners);
  const auto highest = [&](std::span<const Vec3> corners) {
    double height = -HUGE_VAL;
    for (const Vec3& corner : corners) height = std::max(height, plane_.height(corner));
    return height;
  };
  if (highest(inner_) > kSmall) plane_ = plane_.opposite();
  if (highest(inner_) > kSmall || highest(root) < kSmall) return;
  std::vector<Vec3> outline = sight.points.positions(sight.occluders[outer].ring);
  if (neighbour) {
    const auto after = static_cast<std::ptrdiff_t>((neighbour->side + 1) % outline.size());
    std::rotate(outline.begin(), outline.begin() + after, outline.end());
    std::vector<Vec3> other = sight.points.positions(sight.occluders[neighbour->occluder].ring);
    for (std::size_t i = 0; i < other.size(); ++i) {
      const Vec3 &a = other[i], &b = other[(i + 1) % other.size()];
      const double height = std::max(std::abs(plane_.height(a)), std::abs(plane_.height(b))) + kOfHeight;
      behind_ = std::max(behind_, height);
      slivers_.push_back({a, b, height, 2.0 * (kernel::distance(a, b) + kOfHeight) * height, 2.0 * height});
    }
    const auto last = std::ranges::find(other, outline.back());
    if (last == other.end()) return;
    std::rotate(other.begin(), last, other.end());
    if (other.back() != outline.front()) std::reverse(other.begin() + 1, other.end());
    if (other.back() != outline.front()) return;
    outline.insert(outline.end(), other.begin() + 1, other.end() - 1);
  }
  const Side above = plane_.opposite();
  const std::vector<Vec3> beyond = part_behind({above.normal, above.offset - behind_}, inner_);
  if (!beyond.empty()) slivers_.push_back(Sliver::of(beyond, 2.0));
  take_outline(std::move(outline));
  may_be_small_ = !outwards_.empty() && on({}, 1.0, 1.0) < kSmall;
}

// About the longest line between corners. With a chord across it, it spans a part of the polygon: half their product.
CoverBound::Sliver CoverBound::Sliver::of(std::span<const Vec3> convex, double times) {
  Sliver sliver{convex.front(), convex.front(), 0.0, times * most_area({convex.begin(), convex.end()}), 0.0};
  double length = 0.0;
  for (const Vec3& a : convex) {
    for (const Vec3& b : convex) {
      if (kernel::distance(a, b) > length) length = kernel::distance(a, b), sliver.from = a, sliver.to = b;
    }
  }
  const Vec3 along = kernel::difference(sliver.to, sliver.from);
  for (const Vec3& corner : convex) {
    const Vec3 p = kernel::difference(corner, sliver.from);
    const double aside = length > kShortest ? kernel::length(kernel::cross(along, p)) / length : kernel::length(p);
    sliver.thickness = std::max(sliver.thickness, aside + kOfHeight);
  }
  sliver.density = length > kShortest ? 2.0 * sliver.area / length : HUGE_VAL;
  return sliver;
}

double CoverBound::Flux::through(const Sliver& sliver, const Vec3& from, const Vec3& to, int times_to_halve) const {
  Box box;
  box.include(from);
  box.include(to);
  const double margin = sliver.thickness + aside + kOfHeight, apart = gap(cell, box) - margin;
  const double length = kernel::distance(from, to);
  if (times_to_halve > 0 && apart < length && length > kShortest) {
    const Vec3 middle = kernel::along(from, kernel::difference(to, from), 0.5);
    return std::min(sliver.area, through(sliver, from, middle, times_to_halve - 1) +
                                     through(sliver, middle, to, times_to_halve - 1));
  }
  const double area = std::min(sliver.area, sliver.density * (length + kOfHeight));
  if (!(apart > 0.0)) return area;
  const double height = std::max({0.0, receiver.height(from), receiver.height(to)}) + margin;
  return area * std::min(1.0, size / (std::numbers::pi * apart * apart) * std::min(1.0, height / apart));
}

void CoverBound::take_outline(std::vector<Vec3> outline) {
  std::vector<Vec3> corners;
  const auto merge = [&](const Vec3& kept, const Vec3& corner, const Vec3& other) {
    slivers_.push_back(Sliver::of(std::vector{kept, corner, other}, 2.0));
  };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (corners.empty() || kernel::distance(outline[i], corners.back()) > kOneCorner) {
      corners.push_back(outline[i]);
    } else {
      merge(corners.back(), outline[i], outline[(i + 1) % outline.size()]);
    }
  }
  if (corners.size() > 1 && kernel::distance(corners.back(), corners.front()) <= kOneCorner) {
    merge(corners.front(), corners.back(), corners[corners.size() - 2]);
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
  if (sides_.empty()) return HUGE_VAL;
  std::vector<double> reach(sides_.size(), -HUGE_VAL);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    for (const Vec3& corner : inner_) reach[i] = std::max(reach[i], kernel::dot(outwards_[i], corner));
    for (const Vec3& corner : cell) reach[i] = std::max(reach[i], kernel::dot(outwards_[i], corner));
    if (reach[i] - sides_[i] > kSmall) return HUGE_VAL;
  }
  Box box;
  for (const Vec3& corner : cell) box.include(corner);
  double sum = most_area(part_behind({plane_.normal, plane_.offset - behind_}, cell)) * most;
  const Flux flux{receiver_, box, size, behind_};
  const auto count = [&](const Sliver& sliver) { sum += flux.through(sliver, sliver.from, sliver.to, kHalvings); };
  std::ranges::for_each(slivers_, count);
  const std::vector<Vec3> reached = within(reach);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const std::vector<Vec3> beyond = part_behind({kernel::scaled(outwards_[i], -1.0), sides_[i] - kOfHeight}, reached);
    if (!beyond.empty()) count(Sliver::of(beyond, 1.0));
  }
  return sum * kOfBounds;
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
      high = std::max(high, kernel::dot(normal, p) + kOfHeight);
      wide = std::max(wide, to_cell * kernel::dot(across, p) + kOfHeight);
    }
  }
  area_ = static_cast<double>(strip_.size()) * (area(strip) + kOfHeight);
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
  return std::min({area_, size * most, (last - first + kOfHeight) * for_length_}) * kOfBounds;
}

// --- Left out ---

// Where all corners lie in the planes or far from them, as in exact models, nothing need be left out.
bool Omissions::has_near_misses(const Plane& source_plane) const {
  const auto is_near_miss = [&](const Plane& plane, const Side& side, const Point& corner) {
    const double height = std::abs(side.height(corner.at));
    return height < kNearMiss && (height > kRoundedHeight || side_of(plane, corner) != 0);
  };
  const auto misses = [&](const Plane& plane) {
    const Side side = Side::of(plane);
    const auto any_of = [&](const Ring& ring) {
      return std::ranges::any_of(ring, [&](const Edge& e) { return is_near_miss(plane, side, sight_.points[e.from]); });
    };
    return any_of(sight_.source) ||
           std::ranges::any_of(sight_.root.corners, [&](const Point& p) { return is_near_miss(plane, side, p); }) ||
           std::ranges::any_of(sight_.occluders, [&](const Occluder& o) { return any_of(o.ring); });
  };
  return misses(sight_.receiver) || misses(source_plane) ||
         (sight_.occluders.size() <= kMostToMiss &&
          std::ranges::any_of(sight_.occluders, [&](const Occluder& o) { return misses(*o.plane); }));
}

bool Omissions::are_possible() {
  if (!std::exchange(has_bounds_, true)) find_bounds();
  return !hidden_.empty() || !covers_.empty() || !widened_.empty();
}

void Omissions::find_bounds() {
  if (sight_.is_of_open() || sight_.occluders.empty()) return;
  const Plane& source_plane = sight_.source_plane;
  if (!has_near_misses(source_plane)) return;
  std::vector<Vec3> directions;
  const std::size_t most_directions = sight_.occluders.size() <= kMostToCover ? kMostDirections : 3;
  const auto add_direction = [&](const Plane& plane) {
    const Vec3 normal = Side::of(plane).normal;
    const auto is_as = [&](const Vec3& known) { return kernel::length(kernel::cross(known, normal)) < kSameDirection; };
    if (directions.size() < most_directions && std::ranges::none_of(directions, is_as)) directions.push_back(normal);
  };
  add_direction(sight_.receiver);
  add_direction(source_plane);
  for (const Occluder& occluder : sight_.occluders) add_direction(*occluder.plane);
  for (std::uint32_t o = 0; o < sight_.occluders.size(); ++o) {
    HiddenBound bound(sight_, source_plane, directions, sight_.occluders[o]);
    if (bound.may_be_small()) hidden_.emplace_back(o, std::move(bound));
  }
  for (const WidenedOccluder& widened : sight_.widened) {
    const Occluder& occluder = sight_.occluders[widened.original];
    widened_.emplace_back(widened.original,
                          StripBound(sight_, occluder.ring, widened.near, *occluder.plane, StripBound::Sides::kBoth));
  }
  if (sight_.occluders.size() <= kMostToCover) find_covers();
}

void Omissions::find_covers() {
  const auto add = [&](std::uint32_t inner, std::uint32_t outer, std::optional<CoverBound::Neighbour> neighbour) {
    CoverBound bound(sight_, inner, outer, neighbour);
    if (!bound.may_be_small()) return;
    covers_.push_back({inner, {outer}, std::move(bound)});
    if (neighbour) covers_.back().outer.push_back(neighbour->occluder);
  };
  for (std::uint32_t inner = 0; inner < sight_.occluders.size(); ++inner) {
    for (std::uint32_t outer = 0; outer < sight_.occluders.size(); ++outer) {
      if (outer == inner) continue;
      add(inner, outer, {});
      for (const auto& [neighbour, side] : view_.neighbours_of(outer)) {
        if (neighbour == inner || neighbour >= sight_.occluders.size()) continue;
        add(inner, outer, CoverBound::Neighbour{neighbour, side});
      }
    }
  }
}

namespace {

template <class Bounds>
const auto& bound_of(const Bounds& bounds, std::uint32_t occluder) {
  return std::ranges::lower_bound(bounds, occluder, {}, &Bounds::value_type::first)->second;
}

}  // namespace

void Omissions::bound(LeftOut& left_out, const Extent& cell) const {
  left_out.over = left_out.under = 0.0;
  if (left_out.candidates.empty()) return;
  const auto& [corners, most, size] = cell;
  for (std::size_t i = 0; i < left_out.candidates.size(); ++i) {
    const std::uint32_t occluder = left_out.candidates[i].occluder, cover = left_out.covers[i];
    if (cover == LeftOut::kWidened) {
      left_out.under = (left_out.under + bound_of(widened_, occluder).on(corners, size)) * kOfBounds;
    } else {
      left_out.over += cover == LeftOut::kByItself ? bound_of(hidden_, occluder).on(corners, most, size)
                                                   : covers_[cover].bound.on(corners, most, size);
      left_out.over *= kOfBounds;
    }
  }
}

Candidates Omissions::united(const Candidates& candidates, const LeftOut& left_out) const {
  Candidates all;
  all.reserve(candidates.size() + left_out.candidates.size());
  std::ranges::merge(candidates, left_out.candidates, std::back_inserter(all), {}, &Candidate::occluder,
                     &Candidate::occluder);
  std::erase_if(all, [&](const Candidate& candidate) { return candidate.occluder >= sight_.occluders.size(); });
  return all;
}

// Those that hide least come first. One that covers another is left out for what it hides itself, but not for being
// covered: none covers in a circle. One that hides nothing may cover as well: no segment to the source meets it.
LeftOut Omissions::leave_out(const Extent& cell, Candidates& candidates, double trifle) {
  LeftOut left_out;
  if (!are_possible()) return left_out;
  struct Choice {
    double most;
    std::uint32_t occluder, cover;
    [[nodiscard]] auto operator<=>(const Choice&) const = default;
  };
  std::vector<Choice> choices;
  const auto& [corners, most, size] = cell;
  std::vector<bool> is_here(sight_.occluders.size()), covers_other(sight_.occluders.size());
  for (const Candidate& candidate : candidates) is_here[candidate.occluder] = true;
  const std::vector<bool> was_here = is_here;
  const auto are_kept = [&](const std::vector<std::uint32_t>& outer) {
    return std::ranges::all_of(outer,
                               [&](std::uint32_t o) { return is_here[o] || (!was_here[o] && view_.hides_nothing(o)); });
  };
  for (const auto& [occluder, bound] : hidden_) {
    if (is_here[occluder]) choices.push_back({bound.on(corners, most, size), occluder, LeftOut::kByItself});
  }
  for (std::uint32_t i = 0; i < covers_.size(); ++i) {
    const Cover& cover = covers_[i];
    if (!is_here[cover.inner] || !are_kept(cover.outer)) continue;
    choices.push_back({cover.bound.on(corners, most, size), cover.inner, i});
  }
  std::ranges::sort(choices);
  std::vector<std::uint32_t> way(sight_.occluders.size());
  for (const auto& [hidden, occluder, cover] : choices) {
    if (left_out.over + hidden > trifle) break;
    if (!is_here[occluder]) continue;
    if (cover != LeftOut::kByItself) {
      const std::vector<std::uint32_t>& outer = covers_[cover].outer;
      if (covers_other[occluder] || !are_kept(outer)) continue;
      for (const std::uint32_t o : outer) covers_other[o] = true;
    }
    is_here[occluder] = false;
    way[occluder] = cover;
    left_out.over = (left_out.over + hidden) * kOfBounds;
  }
  Candidates instead;
  for (std::uint32_t i = 0; i < widened_.size(); ++i) {
    const auto& [occluder, strip] = widened_[i];
    if (!is_here[occluder]) continue;
    const double hidden = strip.on(corners, size);
    if (left_out.width() + hidden > trifle) continue;
    is_here[occluder] = false;
    way[occluder] = LeftOut::kWidened;
    left_out.under = (left_out.under + hidden) * kOfBounds;
    instead.push_back({static_cast<std::uint32_t>(sight_.occluders.size()) + i});
  }
  std::erase_if(candidates, [&](const Candidate& candidate) {
    if (is_here[candidate.occluder]) return false;
    left_out.candidates.push_back(candidate);
    left_out.covers.push_back(way[candidate.occluder]);
    return true;
  });
  candidates.insert(candidates.end(), instead.begin(), instead.end());
  return left_out;
}

}  // namespace exactff::view_factors
