#include "slips/flip_trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/groups.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "scene/solids.h"
#include "text/phrases.h"

namespace exactff::slips {
namespace {

using kernel::along;
using kernel::cross;
using kernel::difference;

constexpr std::size_t kMostRaysOfSurfaces = 80'000, kMostPointsOfASurface = 192, kFewestPointsOfASurface = 8;

// The k-th point of a sequence in [0, 1]^4 (Roberts, 2018).
std::array<double, 4> place_of(std::size_t k) {
  constexpr std::array<double, 4> kSteps = {0.8566748838545029, 0.7338918566271259, 0.6287067210378086,
                                            0.5385972572236101};
  std::array<double, 4> place{};
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double x = 0.5 + static_cast<double>(k + 1) * kSteps[i];
    place[i] = x - std::floor(x);
  }
  return place;
}

double area_of(const Scene& scene, std::uint32_t piece) {
  const auto corners = scene.corners(scene.pieces()[piece]);
  const auto at = [&](std::size_t i) { return scene.vertices()[corners[i]]; };
  double area = 0.0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    area += 0.5 * kernel::length(cross(difference(at(i - 1), at(0)), difference(at(i), at(0))));
  }
  return area;
}

// Uniform by area, for `u` and `v` in [0, 1].
Vec3 point_in(const Scene& scene, std::uint32_t piece, double u, double v) {
  const auto corners = scene.corners(scene.pieces()[piece]);
  const auto at = [&](std::size_t i) { return scene.vertices()[corners[i]]; };
  const auto twice_area = [&](std::size_t i) {
    return kernel::length(cross(difference(at(i - 1), at(0)), difference(at(i), at(0))));
  };
  double rest = u * 2.0 * area_of(scene, piece);
  std::size_t i = 2;
  while (i + 1 < corners.size() && rest > twice_area(i)) rest -= twice_area(i++);
  const double root = std::sqrt(std::clamp(rest / twice_area(i), 0.0, 1.0));
  const Vec3 on_side = along(at(i - 1), difference(at(i), at(i - 1)), v);
  return along(at(0), difference(on_side, at(0)), root);
}

// About a normal of length 1, distributed by the cosine.
Vec3 direction_before(const Vec3& normal, double u, double v) {
  const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 a = kernel::unit(cross(normal, axis)), b = cross(normal, a);
  const double radius = std::sqrt(u), turn = 2.0 * std::numbers::pi * v;
  const Vec3 level = along(kernel::scaled(a, radius * std::cos(turn)), b, radius * std::sin(turn));
  return along(level, normal, std::sqrt(1.0 - u));
}

}  // namespace

Outlook::Outlook(const Scene& scene, const SightLines& sight) : scene_(scene), surface_(oriented_surfaces(scene)) {
  if (!sight.usable()) return;
  std::vector<std::vector<std::uint32_t>> pieces;  // by surface
  for (std::uint32_t piece = 0; piece < surface_.size(); ++piece) {
    if (surface_[piece] >= pieces.size()) pieces.resize(surface_[piece] + 1);
    pieces[surface_[piece]].push_back(piece);
  }
  const std::size_t count = std::min(kMostPointsOfASurface, kMostRaysOfSurfaces / (2 * pieces.size()));
  if (count < kFewestPointsOfASurface) return;
  for (const std::vector<std::uint32_t>& of_one : pieces) cast(sight, of_one, count);
}

// The points are spread over the area of the surface.
void Outlook::cast(const SightLines& sight, const std::vector<std::uint32_t>& pieces, std::size_t count) {
  std::vector<double> sums{0.0};
  for (const std::uint32_t piece : pieces) sums.push_back(sums.back() + area_of(scene_, piece));
  const double step = sums.back() / static_cast<double>(count);
  std::size_t p = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + 0.5) * step;
    while (p + 1 < pieces.size() && sums[p + 1] < at) ++p;
    const std::array<double, 4> place = place_of(k);
    const Vec3 point = point_in(scene_, pieces[p], place[0], place[1]);
    if (!is_covered(sight, pieces[p], point)) cast(sight, pieces[p], point, place.data() + 2, step);
  }
}

void Outlook::cast(const SightLines& sight, std::uint32_t piece, const Vec3& point, const double* place, double area) {
  kernel::poll();
  for (const Side side : {0U, 1U}) {
    const Vec3 normal = kernel::scaled(sight.normal(piece), side == 0 ? 1.0 : -1.0);
    Ray& ray = rays_.emplace_back(Ray{.from = 2 * piece + side, .area = area});
    double last = -HUGE_VAL;
    for (const Hit& hit : sight.hits_in_sight(point, direction_before(normal, place[0], place[1]), HUGE_VAL)) {
      ray.clear = ray.clear && hit.distance - last > 1e-9 * sight.diameter();
      ray.ends = ray.ends || !scene_.pieces()[hit.piece].transparent;
      ray.seen.push_back(2 * hit.piece + (hit.front ? 0 : 1));
      last = hit.distance;
    }
  }
}

bool Outlook::is_covered(const SightLines& sight, std::uint32_t piece, const Vec3& point) const {
  bool covered = false;
  visit_pieces_near(scene_, {point, point}, 1e-9 * sight.diameter(), [&](std::uint32_t other) {
    covered = other != piece && sight.holds(other, point);
    return !covered;
  });
  return covered;
}

bool Outlook::is_good(const Ray& ray, const Flipped& flipped) const {
  return is_front(ray.from, flipped) &&
         std::ranges::any_of(ray.seen, [&](Side side) { return is_front(side, flipped); });
}

Outlook::Lost Outlook::lost(const Flipped& flipped) const {
  Lost lost;
  for (const Ray& ray : rays_) {
    if (!is_front(ray.from, flipped) || is_good(ray, flipped)) continue;
    (ray.ends ? lost.to_backs : lost.to_nothing) += ray.area;
  }
  return lost;
}

// --- Oriented surfaces ---

namespace {

std::vector<EdgeOfPiece> edges_of_pieces(const Scene& scene) {
  std::vector<EdgeOfPiece> edges;
  for (std::uint32_t piece = 0; piece < scene.pieces().size(); ++piece) {
    const auto corners = scene.corners(scene.pieces()[piece]);
    std::uint32_t from = places(scene)[corners.back()];
    for (const std::uint32_t corner : corners) {
      const std::uint32_t to = places(scene)[corner];
      edges.push_back({std::min(from, to), std::max(from, to), piece, from < to});
      from = to;
    }
  }
  return edges;
}

template <class TakeOthers>
void join_at(std::vector<EdgeOfPiece>& edges, Groups& pieces, const TakeOthers& take_others) {
  for_each_edge(edges, [&](auto first, auto last) {
    if (last - first != 2 || balance_of(first, last) != 0) return take_others(first, last);
    pieces.join(first->piece, (first + 1)->piece);
  });
}

}  // namespace

std::vector<std::uint32_t> oriented_surfaces(const Scene& scene) {
  Groups pieces(scene.pieces().size());
  for (std::uint32_t p = 1; p < scene.pieces().size(); ++p) {
    if (scene.pieces()[p].face == scene.pieces()[p - 1].face) pieces.join(p, p - 1);
  }
  std::vector<EdgeOfPiece> edges = edges_of_pieces(scene), others;
  join_at(edges, pieces, [&](auto first, auto last) { others.insert(others.end(), first, last); });
  cut_at_junctions(others, scene.vertices());
  join_at(others, pieces, [](auto, auto) {});
  constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::vector<std::uint32_t> number(scene.pieces().size(), kNone), of_piece;
  std::uint32_t count = 0;
  for (std::uint32_t piece = 0; piece < number.size(); ++piece) {
    std::uint32_t& one = number[pieces.root(piece)];
    if (one == kNone) one = count++;
    of_piece.push_back(one);
  }
  return of_piece;
}

// --- Trials ---

// For each patch that is turned round, before and after:
//   1. rays from a few of its points into the half-space before them;
//   2. lines from its points to points of the faces before it, which finds small things that the rays miss.
// Every front on a ray or line up to the first face that is not transparent is a pair. Of faces in one plane all fronts
// count, before backs.

namespace {

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
    : scene_(scene), sight_(scene), pieces_(pieces_by_patch(scene)), emits_(scene.patches().size()) {
  for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) ends_.push_back(p);
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

std::size_t FlipTrials::patch_of(std::uint32_t piece) const { return index_of(slips::patch_of(scene_, piece)); }

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
  bool found = false;
  visit_pieces_near(scene_, box_of(scene_, piece), kBefore * sight_.diameter(), [&](std::uint32_t other) {
    const bool may = patch_of(other) != patch_of(piece) && !flipped[index_of(scene_.pieces()[other].face)] &&
                     dot(front_of(piece, flipped), sight_.normal(other)) > 0.0;
    found = may && overlap_of(scene_, sight_, piece, other).has_value();
    return !found;
  });
  return found;
}

// --- Outward rooms ---

// Rooms whose walls look out of them, all or some, as programs for buildings write rooms.
//
// A side of a surface is its front or its back. Sides that see each other, by rays, are around one space: the inside of
// a room, that of a box, or what lies between them. So T-junctions, concave walls and things that touch do no harm.
// For each space, the surfaces that show it their backs are turned round on trial. It helps if
//   1. much less is lost, that is, less of what all fronts look at shows backs or nothing;
//   2. what else sees them, or is seen by them, does not become less: a box that stands among other things looks out.
// Where no front looks into the space and it holds nothing, it may as well be the inside of a solid. Then most of the
// area must see nothing now.

namespace {

constexpr double kLeastShare = 0.03;     // of the rays of a side, for it to see another one
constexpr double kWorthIt = 0.1;         // of the area that is turned: what must be won
constexpr double kFew = 0.25;            // of the views of what may be a solid
constexpr double kHardlyInUse = 0.05;    // of the area of what holds something
constexpr std::size_t kMostTried = 16;   // spaces at a time, the largest first
constexpr std::size_t kMostTurned = 64;  // spaces

// The side of a surface: twice its number, and 1 more for its back.
using SurfaceSide = std::uint32_t;

struct Space {
  std::vector<std::uint32_t> surfaces;  // with one side around it
  bool holds_sheets = false;            // surfaces with both sides in it
  double open = 0.0;                    // share of the views that meet nothing
};

class RoomFinder {
 public:
  explicit RoomFinder(const Scene& scene)
      : scene_(scene), sight_(scene), outlook_(scene, sight_), flipped_(scene.faces().size()) {
    for (std::uint32_t piece = 0; piece < scene_.pieces().size(); ++piece) {
      const std::uint32_t surface = surface_of(piece);
      if (surface >= faces_.size()) faces_.resize(surface + 1);
      faces_[surface].insert(scene_.pieces()[piece].face);
    }
    areas_.resize(faces_.size());
    for (std::size_t s = 0; s < faces_.size(); ++s) {
      for (const FaceId face : faces_[s]) areas_[s] += scene_.face(face).area;
    }
    if (!outlook_.rays().empty()) find_spaces();
  }

  // The faces to turn round, and how many there are around the same spaces.
  struct Found {
    std::vector<FaceId> faces;
    std::size_t of = 0;
    bool may_be_solid = false;  // nothing but the shape of the scene tells
  };
  Found find() {
    Found found;
    for (std::size_t turned = 0; turned < kMostTurned; ++turned) {
      const auto [space, surfaces] = best();
      if (surfaces.empty()) break;
      found.may_be_solid = !is_room_for_sure(*space, surfaces);
      for (const std::uint32_t s : space->surfaces) found.of += faces_[s].size();
      turn(surfaces);
    }
    for (std::size_t f = 0; f < flipped_.size(); ++f) {
      if (flipped_[f]) found.faces.push_back(static_cast<FaceId>(f));
    }
    return found;
  }

 private:
  [[nodiscard]] std::uint32_t surface_of(std::uint32_t piece) const { return outlook_.surface_of_piece()[piece]; }
  [[nodiscard]] SurfaceSide surface_side(Side side) const { return 2 * surface_of(piece_of(side)) + side % 2; }

  void find_spaces() {
    const std::vector<SurfaceSide> roots = join_sides();
    std::map<SurfaceSide, Space> spaces;
    for (SurfaceSide side = 0; side < roots.size(); side += 2) {
      if (roots[side] == roots[side + 1]) {
        spaces[roots[side]].holds_sheets = true;
        continue;
      }
      for (const SurfaceSide one : {side, side + 1}) {
        spaces[roots[one]].surfaces.push_back(side / 2);
        looks_in_[{roots[one], side / 2}] = one == side;
      }
    }
    find_open(roots, spaces);
    for (auto& [root, space] : spaces) spaces_.emplace_back(root, std::move(space));
    const auto area = [&](const auto& one) {
      double sum = 0.0;
      for (const std::uint32_t s : one.second.surfaces) sum += areas_[s];
      return sum;
    };
    std::ranges::stable_sort(spaces_, std::greater{}, area);
  }

  void find_open(const std::vector<SurfaceSide>& roots, std::map<SurfaceSide, Space>& spaces) const {
    std::map<SurfaceSide, double> all, open;
    for (const Outlook::Ray& ray : outlook_.rays()) {
      const SurfaceSide root = roots[surface_side(ray.from)];
      all[root] += ray.area;
      if (!ray.ends) open[root] += ray.area;
    }
    for (auto& [root, space] : spaces)
      if (all[root] > 0.0) space.open = open[root] / all[root];
  }

  // By side, one that stands for all that are around the same space.
  std::vector<SurfaceSide> join_sides() {
    Groups spaces(2 * faces_.size());
    std::vector<std::size_t> rays(2 * faces_.size());
    std::map<std::pair<SurfaceSide, SurfaceSide>, std::size_t> counts;
    for (const Outlook::Ray& ray : outlook_.rays()) {
      const SurfaceSide from = surface_side(ray.from);
      ++rays[from];
      if (!ray.clear) continue;
      for (const Side side : ray.seen) ++counts[{from, surface_side(side)}];
    }
    for (const auto& [pair, count] : counts) {
      const double least = kLeastShare * static_cast<double>(rays[pair.first]);
      if (count >= 2 && static_cast<double>(count) >= least) spaces.join(pair.first, pair.second);
    }
    std::vector<SurfaceSide> roots;
    for (SurfaceSide side = 0; side < rays.size(); ++side) roots.push_back(spaces.root(side));
    return roots;
  }

  // Of the spaces that surfaces are turned to with success, the one where most is won.
  std::pair<const Space*, std::vector<std::uint32_t>> best() {
    std::pair<const Space*, std::vector<std::uint32_t>> best;
    double most = 0.0;
    std::size_t tried = 0;
    for (const auto& [root, space] : spaces_) {
      std::vector<std::uint32_t> turned;  // that show it their backs
      for (const std::uint32_t s : space.surfaces) {
        if (looks_in_.at({root, s}) == is_turned(s)) turned.push_back(s);
      }
      if (turned.empty()) continue;
      if (++tried > kMostTried) break;
      const double won = won_by(space, turned);
      if (won <= most) continue;
      most = won;
      best = {&space, turned};
    }
    return best;
  }

  // By patch: whether one of its fronts sees a front.
  [[nodiscard]] std::vector<bool> patches_that_see() const {
    std::vector<bool> see(scene_.patches().size(), false);
    for (const Outlook::Ray& ray : outlook_.rays()) {
      if (outlook_.is_good(ray, flipped_)) see[patch_of(scene_.pieces()[piece_of(ray.from)].face)] = true;
    }
    return see;
  }
  [[nodiscard]] std::size_t patch_of(FaceId face) const { return index_of(scene_.face(face).patch); }

  // In an open space, patches that see nothing are unseen fronts each by itself, which unseen_fronts() tells.
  [[nodiscard]] bool is_told_otherwise(const Space& space, const std::vector<std::uint32_t>& surfaces) const {
    constexpr double kClosed = 0.02;
    if (space.open < kClosed) return false;
    const std::vector<bool> see = patches_that_see();
    return std::ranges::all_of(surfaces, [&](std::uint32_t s) {
      return std::ranges::none_of(faces_[s], [&](FaceId face) { return see[patch_of(face)]; });
    });
  }

  // 0 if it does not help.
  double won_by(const Space& space, const std::vector<std::uint32_t>& surfaces) {
    constexpr double kOutdoors = 0.4;  // no room: fronts may well look elsewhere
    if (space.open > kOutdoors) return 0.0;
    const bool sure = is_room_for_sure(space, surfaces);
    if (is_told_otherwise(space, surfaces) || (!sure && !may_be_room(surfaces))) return 0.0;
    const double lost = outlook_.lost(flipped_).total(), in_use = in_use_by_others(surfaces);
    turn(surfaces);
    const double won = lost - outlook_.lost(flipped_).total(), in_use_then = in_use_by_others(surfaces);
    turn(surfaces);
    const double area = area_of(surfaces), may_be_less = sure ? kHardlyInUse * area : 0.0;
    return won > kWorthIt * area && in_use_then >= in_use - may_be_less ? won : 0.0;
  }

  [[nodiscard]] static bool is_room_for_sure(const Space& space, const std::vector<std::uint32_t>& turned) {
    return space.holds_sheets || turned.size() < space.surfaces.size();
  }

  // Most of the area is of patches that see nothing, and few of the views are good: the walls of a hollow see each
  // other.
  [[nodiscard]] bool may_be_room(const std::vector<std::uint32_t>& surfaces) const {
    double good = 0.0, sees_nothing = 0.0;
    for (const Outlook::Ray& ray : outlook_.rays()) {
      const bool own = std::ranges::binary_search(surfaces, surface_of(piece_of(ray.from)));
      if (own && outlook_.is_good(ray, flipped_)) good += ray.area;
    }
    const std::vector<bool> see = patches_that_see();
    for (const std::uint32_t s : surfaces) {
      for (const FaceId face : faces_[s]) {
        if (!see[patch_of(face)]) sees_nothing += scene_.face(face).area;
      }
    }
    const double area = area_of(surfaces);
    return sees_nothing > 0.5 * area && good < kFew * area;
  }

  // Of the good rays between these surfaces and all others, their area.
  double in_use_by_others(const std::vector<std::uint32_t>& surfaces) {
    const auto is_one = [&](Side side) { return std::ranges::binary_search(surfaces, surface_of(piece_of(side))); };
    double area = 0.0;
    for (const Outlook::Ray& ray : outlook_.rays()) {
      const bool own = is_one(ray.from);
      const bool between = outlook_.is_front(ray.from, flipped_) && std::ranges::any_of(ray.seen, [&](Side side) {
                             return own != is_one(side) && outlook_.is_front(side, flipped_);
                           });
      if (between) area += ray.area;
    }
    return area;
  }

  [[nodiscard]] bool is_turned(std::uint32_t surface) const { return flipped_[index_of(*faces_[surface].begin())]; }
  void turn(const std::vector<std::uint32_t>& surfaces) {
    for (const std::uint32_t s : surfaces) {
      for (const FaceId face : faces_[s]) flipped_[index_of(face)] = !flipped_[index_of(face)];
    }
  }
  [[nodiscard]] double area_of(const std::vector<std::uint32_t>& surfaces) const {
    double area = 0.0;
    for (const std::uint32_t s : surfaces) area += areas_[s];
    return area;
  }

  const Scene& scene_;
  const SightLines sight_;
  const Outlook outlook_;
  Flipped flipped_;
  std::vector<std::set<FaceId>> faces_;  // by surface
  std::vector<double> areas_;            // by surface
  std::vector<std::pair<SurfaceSide, Space>> spaces_;
  std::map<std::pair<SurfaceSide, std::uint32_t>, bool> looks_in_;  // by space and surface, as in the scene
};

}  // namespace

std::optional<Finding> outward_rooms(const Scene& scene, std::span<const Selection> turned) {
  const std::optional<Scene> corrected = turned.empty() ? std::nullopt : std::optional(scene.with_flipped(turned));
  RoomFinder::Found found = RoomFinder(corrected ? *corrected : scene).find();
  for (const Selection& one : turned) {
    const std::vector<FaceId> faces = scene.faces_of(one);
    std::erase_if(found.faces, [&](FaceId face) { return std::ranges::find(faces, face) != faces.end(); });
  }
  if (found.faces.empty()) return std::nullopt;
  const std::size_t count = found.faces.size();
  Finding finding{.kind = Kind::kOutwardRoom, .objects = selections_of(scene, std::move(found.faces))};
  finding.flag = flag_to_flip(scene, finding.objects);
  finding.words = {
      .what = text::counted_of(count, found.of, "face") + " around a room look" +
              (count == 1 || count == found.of ? "s" : "") + " out of it: " + listed(scene, finding.objects),
      .why = "what is inside sees their backs, which emit nothing and receive nothing",
      .suggestion = (found.may_be_solid ? "unless it is a solid, " : "") + words_to_flip(scene, finding.objects)};
  return finding;
}

}  // namespace exactff::slips
