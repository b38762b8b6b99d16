#include "view_factors/patch_bounds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/poll.h"
#include "view_factors/near_planes.h"
#include "view_factors/patch_parts.h"

namespace exactff::view_factors {
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
