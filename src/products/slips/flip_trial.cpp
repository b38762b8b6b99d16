// For each patch that is turned round, before and after:
//   1. rays from a few of its points into the half-space before them;
//   2. lines from its points to points of the faces before it, which finds small things that the rays miss.
// Every front on a ray or line up to the first face that is not transparent is a pair. Of faces in one plane all fronts
// count, before backs.
#include "slips/flip_trial.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kernel/vec.h"

namespace exactff::slips {
namespace {

using kernel::difference;
using kernel::dot;

constexpr std::uint64_t kMostRaysOfTrials = 200'000;  // of all trials, lines included
constexpr std::size_t kMostOnFronts = 4096;           // pieces of a patch that may come to lie on a front
constexpr double kBefore = 1e-9;                      // of the scene's diameter: before a plane, not in it

}  // namespace

bool FlipEffect::darkens() const {
  const auto of_two = [](const PairsInSight& pairs) {
    return std::ranges::count_if(pairs, [](const auto& pair) { return pair.first != pair.second; });
  };
  return !is_complete || stacks || shows_backs || after.size() < before.size() || of_two(after) < of_two(before) ||
         lit_after < lit_before;
}

std::vector<std::pair<std::size_t, std::size_t>> FlipEffect::gained() const {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  std::ranges::set_difference(after, before, std::back_inserter(result));
  std::erase_if(result, [](const auto& pair) { return pair.first == pair.second; });
  return result;
}

FlipTrials::FlipTrials(const Scene& scene)
    : scene_(scene), sight_(scene), pieces_(scene.patches().size()), emits_(scene.patches().size()) {
  for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) {
    pieces_[patch_of(p)].push_back(p);
    ends_.push_back(p);
  }
  ends_ = spread(ends_, kLinesTo);
  for (const Selection& emitter : scene.emitters()) emits_[index_of(emitter.patch)] = true;
}

FlipEffect FlipTrials::try_flip(std::span<const Selection> selections) {
  FlipEffect effect;
  Flipped as_they_are(scene_.faces().size()), flipped(scene_.faces().size());
  std::set<std::size_t> patches;
  for (const Selection& selection : selections) {
    patches.insert(index_of(selection.patch));
    for (const FaceId face : scene_.faces_of(selection)) flipped[index_of(face)] = true;
  }
  for (const std::size_t patch : patches) {
    if (!sight_.usable() || rays_ >= kMostRaysOfTrials) break;
    look(patch, as_they_are, effect.before);
    look(patch, flipped, effect.after);
  }
  effect.is_complete = sight_.usable() && rays_ < kMostRaysOfTrials;
  effect.lit_before = lit(effect.before);
  effect.lit_after = lit(effect.after);
  if (effect.darkens()) return effect;
  effect.shows_backs = shows_more_backs(as_they_are, flipped);
  if (effect.darkens()) return effect;
  effect.stacks = std::ranges::any_of(patches, [&](std::size_t patch) {
    return std::ranges::any_of(spread(pieces_[patch], kMostOnFronts),
                               [&](std::uint32_t piece) { return is_on_a_front(piece, flipped); });
  });
  return effect;
}

std::vector<Selection> FlipTrials::useful_flips(std::span<const Selection> selections) {
  if (selections.empty()) return {};
  const auto gained = try_flip(selections).gained();
  std::vector<Selection> useful;
  std::ranges::copy_if(selections, std::back_inserter(useful), [&](const Selection& one) {
    const std::size_t patch = index_of(one.patch);
    return std::ranges::any_of(gained, [&](const auto& pair) { return pair.first == patch || pair.second == patch; });
  });
  return !useful.empty() && try_flip(useful).helps() ? useful : std::vector<Selection>();
}

std::size_t FlipTrials::patch_of(std::uint32_t piece) const {
  return index_of(scene_.face(scene_.pieces()[piece].face).patch);
}

Vec3 FlipTrials::front_of(std::uint32_t piece, const Flipped& flipped) const {
  const Vec3& normal = sight_.normal(piece);
  return flipped[index_of(scene_.pieces()[piece].face)] ? kernel::scaled(normal, -1.0) : normal;
}

void FlipTrials::look(std::size_t patch, const Flipped& flipped, PairsInSight& pairs) {
  cast_rays(patch, flipped, pairs);
  draw_lines(patch, flipped, pairs);
}

void FlipTrials::cast_rays(std::size_t patch, const Flipped& flipped, PairsInSight& pairs) {
  for (const std::uint32_t piece : spread(pieces_[patch], kOrigins)) {
    const Vec3 from = sight_.points_of(piece).front(), front = front_of(piece, flipped);
    for (int i = 0; i < kRaysOfAnOrigin; ++i) follow(patch, from, ray_before(front, i), HUGE_VAL, flipped, pairs);
  }
}

// Between centres first, then between all points, to patches that are not yet in sight.
void FlipTrials::draw_lines(std::size_t patch, const Flipped& flipped, PairsInSight& pairs) {
  const std::uint64_t last = rays_ + kMostLines;
  for (const std::size_t points : {std::size_t{1}, std::size_t{64}}) {
    for (const std::uint32_t from : spread(pieces_[patch], kLinesFrom)) {
      for (const std::uint32_t to : ends_) {
        if (rays_ >= last) return;
        if (pairs.contains(std::minmax(patch, patch_of(to)))) continue;
        draw_lines(from, to, points, flipped, pairs);
      }
    }
  }
}

void FlipTrials::draw_lines(std::uint32_t from, std::uint32_t to, std::size_t points, const Flipped& flipped,
                            PairsInSight& pairs) {
  const std::vector<Vec3> starts = sight_.points_of(from), ends = sight_.points_of(to);
  const Vec3 front = front_of(from, flipped), front_of_end = front_of(to, flipped);
  const double before = kBefore * sight_.diameter();
  for (std::size_t s = 0; s < std::min(points, starts.size()); ++s) {
    for (std::size_t e = 0; e < std::min(points, ends.size()); ++e) {
      const Vec3 way = difference(ends[e], starts[s]);
      if (!(dot(front, way) > before && dot(front_of_end, way) < -before)) continue;
      follow(patch_of(from), starts[s], way, 1.0 + kBefore, flipped, pairs);
      if (pairs.contains(std::minmax(patch_of(from), patch_of(to)))) return;
    }
  }
}

void FlipTrials::follow(std::size_t patch, const Vec3& from, const Vec3& direction, double limit,
                        const Flipped& flipped, PairsInSight& pairs) {
  ++rays_;
  for (const Hit& hit : sight_.hits_in_sight(from, direction, limit)) {
    if (hit.front != flipped[index_of(scene_.pieces()[hit.piece].face)])
      pairs.insert(std::minmax(patch, patch_of(hit.piece)));
  }
}

std::size_t FlipTrials::lit(const PairsInSight& pairs) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(pairs, [&](const auto& pair) { return emits_[pair.first] || emits_[pair.second]; }));
}

// By more than a little of the area that is turned round.
bool FlipTrials::shows_more_backs(const Flipped& as_they_are, const Flipped& flipped) {
  constexpr double kLittle = 0.01;
  if (!outlook_) outlook_.emplace(scene_, sight_);
  double area = 0.0;
  for (std::size_t f = 0; f < flipped.size(); ++f) area += flipped[f] ? scene_.faces()[f].area : 0.0;
  return outlook_->lost(flipped).to_backs > outlook_->lost(as_they_are).to_backs + kLittle * area;
}

bool FlipTrials::is_on_a_front(std::uint32_t piece, const Flipped& flipped) const {
  if (!flipped[index_of(scene_.pieces()[piece].face)]) return false;
  const auto corners = scene_.corners(scene_.pieces()[piece]);
  Box box{scene_.vertices()[corners.front()], scene_.vertices()[corners.front()]};
  for (const std::uint32_t corner : corners) box.include(scene_.vertices()[corner]);
  bool found = false;
  visit_pieces_near(scene_, box, kBefore * sight_.diameter(), [&](std::uint32_t other) {
    const bool may = patch_of(other) != patch_of(piece) && !flipped[index_of(scene_.pieces()[other].face)] &&
                     dot(front_of(piece, flipped), sight_.normal(other)) > 0.0;
    found = may && overlap_of(scene_, sight_, piece, other).has_value();
    return !found;
  });
  return found;
}

}  // namespace exactff::slips
