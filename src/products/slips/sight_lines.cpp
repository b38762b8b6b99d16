#include "slips/sight_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "slips/flip_trial.h"
#include "text/phrases.h"
#include "text/text_lines.h"

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
  for (std::uint32_t piece = 0; piece < scene.pieces().size(); ++piece) {
    normals_.push_back(unit(front_of_piece(scene, piece)));
    for (const std::uint32_t corner : scene.corners(scene.pieces()[piece])) box.include(scene.vertices()[corner]);
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

Box box_of(const Scene& scene, std::uint32_t piece) {
  return exactff::box_of(scene, scene.corners(scene.pieces()[piece]));
}

std::vector<std::uint32_t> sorted_places(const Scene& scene, const Face& face) {
  std::vector<std::uint32_t> result;
  for (const auto& ring : face.rings) {
    for (const std::uint32_t v : ring) result.push_back(places(scene)[v]);
  }
  std::ranges::sort(result);
  return result;
}

bool holds(const Box& outer, const Box& inner) {
  const auto within = [&](double Vec3::*c) { return outer.low.*c <= inner.low.*c && inner.high.*c <= outer.high.*c; };
  return within(&Vec3::x) && within(&Vec3::y) && within(&Vec3::z);
}

std::vector<std::vector<std::uint32_t>> pieces_by_patch(const Scene& scene) {
  std::vector<std::vector<std::uint32_t>> pieces(scene.patches().size());
  for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) pieces[index_of(patch_of(scene, p))].push_back(p);
  return pieces;
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

bool is_within(const Scene& scene, std::span<const std::uint32_t> pieces, const Vec3& point, std::uint64_t& triangles) {
  constexpr double kHalfSphere = 6.283185307179586;
  double sum = 0.0;
  for (const std::uint32_t piece : pieces) {
    const auto corners = scene.corners(scene.pieces()[piece]);
    const auto seen = [&](std::size_t i) { return kernel::difference(scene.vertices()[corners[i]], point); };
    for (std::size_t i = 2; i < corners.size(); ++i) sum += solid_angle(seen(0), seen(i - 1), seen(i));
    triangles += corners.size() - 2;
  }
  return std::abs(sum) > kHalfSphere;
}

// --- Overlaps ---

// Fronts of different patches that lie on each other. For each piece, the spatial tree gives the others whose boxes
// come near it; those in its plane are clipped by it.

namespace {

constexpr double kSliver = 1e-6;       // of the smaller piece's area
constexpr double kSliverApart = 1e-4;  // likewise, if they do not lie in one plane
constexpr double kNear = 1e-6;         // of the larger piece's diameter
constexpr std::uint64_t kMostVisits = 20'000'000, kMostVisitsOfAPiece = 64;  // on average
constexpr std::uint64_t kMostOverlaps = 2'000'000;                           // of pieces

struct Point2 {
  double u = 0.0, v = 0.0;
};
using Polygon = std::vector<Point2>;  // convex, counter-clockwise

double twice_area(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Point2 &a = polygon[0], &b = polygon[i - 1], &c = polygon[i];
    sum += (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
  }
  return sum;
}

// The part to the left of the line from a to b (Sutherland and Hodgman, 1974).
Polygon left_part(const Polygon& polygon, const Point2& a, const Point2& b) {
  const auto side = [&](const Point2& p) { return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u); };
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = side(p), at_q = side(q);
    if (at_p >= 0.0) part.push_back(p);
    if ((at_p < 0.0) == (at_q < 0.0)) continue;
    const double t = at_p / (at_p - at_q);
    part.push_back({p.u + t * (q.u - p.u), p.v + t * (q.v - p.v)});
  }
  return part;
}

// A plane with coordinates whose origin is a corner of a piece in it.
class Plane {
 public:
  Plane(const Scene& scene, const SightLines& sight, std::uint32_t piece)
      : scene_(scene),
        origin_(scene.vertices()[scene.corners(scene.pieces()[piece]).front()]),
        normal_(sight.normal(piece)) {
    const Vec3 axis = std::abs(normal_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    u_ = kernel::unit(cross(normal_, axis));
    v_ = cross(normal_, u_);
  }

  [[nodiscard]] double distance(std::uint32_t piece) const {
    double largest = 0.0;
    for (const std::uint32_t corner : scene_.corners(scene_.pieces()[piece]))
      largest = std::max(largest, std::abs(dot(normal_, from_origin(corner))));
    return largest;
  }

  [[nodiscard]] Polygon outline(std::uint32_t piece) const {
    Polygon outline;
    for (const std::uint32_t corner : scene_.corners(scene_.pieces()[piece]))
      outline.push_back({dot(u_, from_origin(corner)), dot(v_, from_origin(corner))});
    if (twice_area(outline) < 0.0) std::ranges::reverse(outline);
    return outline;
  }

 private:
  [[nodiscard]] Vec3 from_origin(std::uint32_t corner) const { return difference(scene_.vertices()[corner], origin_); }

  const Scene& scene_;
  Vec3 origin_, normal_, u_, v_;
};

double diameter_of(const Scene& scene, std::uint32_t piece) {
  const Box box = box_of(scene, piece);
  return kernel::distance(box.high, box.low);
}

bool are_in_one_plane(const Scene& scene, const Piece& a, const Piece& b) {
  const auto at = [&](std::uint32_t v) { return scene.vertices()[v]; };
  return std::ranges::all_of(b.frame, [&](std::uint32_t v) {
    return kernel::orientation(at(a.frame[0]), at(a.frame[1]), at(a.frame[2]), at(v)) == 0;
  });
}

class OverlapFinder {
 public:
  OverlapFinder(const Scene& scene, std::span<const Selection> selections)
      : scene_(scene), sight_(scene), owner_(scene.pieces().size(), kNobody), areas_(selections.size()) {
    for (std::uint32_t s = 0; s < selections.size(); ++s) {
      for (const FaceId face : scene.faces_of(selections[s])) take(s, face);
    }
  }

  std::vector<Overlap> find(std::span<const Selection> selections) {
    if (!sight_.usable()) return {};
    for (std::uint32_t piece = 0; piece < owner_.size(); ++piece) {
      if (owner_[piece] != kNobody) look_around(piece);
    }
    std::vector<Overlap> overlaps;
    for (const auto& [pair, sum] : sums_) overlaps.push_back(overlap(selections, pair, sum));
    std::ranges::stable_sort(overlaps, std::greater{}, &Overlap::area);
    return overlaps;
  }

 private:
  static constexpr std::uint32_t kNobody = 0xFFFFFFFFU;
  struct Sum {
    double area = 0.0, apart = std::numeric_limits<double>::infinity();
    bool doubled = true;
  };

  void take(std::uint32_t selection, FaceId id) {
    const Face& face = scene_.face(id);
    areas_[selection] += face.area;
    for (std::uint32_t p = face.first_piece; p < face.first_piece + face.piece_count; ++p) {
      if (owner_[p] == kNobody) owner_[p] = selection;
    }
  }

  void look_around(std::uint32_t piece) {
    kernel::poll();
    const Box box = box_of(scene_, piece);
    visit_pieces_near(scene_, box, kNear * sight_.diameter(), [&](std::uint32_t other) {
      if (other < piece && owner_[other] != kNobody && owner_[other] != owner_[piece]) compare(piece, other);
      return ++visits_ < most_visits_ && found_ < kMostOverlaps;
    });
  }

  void compare(std::uint32_t piece, std::uint32_t other) {
    if (!(dot(sight_.normal(piece), sight_.normal(other)) > 0.0)) return;
    const std::optional<PieceOverlap> common = overlap_of(scene_, sight_, piece, other);
    if (!common) return;
    ++found_;
    Sum& sum = sums_[std::minmax(owner_[piece], owner_[other])];
    sum.area += common->area;
    sum.apart = std::min(sum.apart, common->apart);
    sum.doubled = sum.doubled &&
                  have_same_corners(scene_.face(scene_.pieces()[piece].face), scene_.face(scene_.pieces()[other].face));
  }

  [[nodiscard]] bool have_same_corners(const Face& a, const Face& b) const {
    const auto size = [](const auto& ring) { return ring.size(); };
    return std::ranges::equal(a.rings, b.rings, {}, size, size) && sorted_places(scene_, a) == sorted_places(scene_, b);
  }

  [[nodiscard]] Overlap overlap(std::span<const Selection> selections, std::pair<std::uint32_t, std::uint32_t> pair,
                                const Sum& sum) const {
    const auto [a, b] = pair;
    const bool a_is_smaller = areas_[a] < areas_[b];
    return {.smaller = selections[a_is_smaller ? a : b],
            .larger = selections[a_is_smaller ? b : a],
            .area = std::min({sum.area, areas_[a], areas_[b]}),
            .apart = sum.apart,
            .doubled = sum.doubled};
  }

  const Scene& scene_;
  const SightLines sight_;
  std::vector<std::uint32_t> owner_;  // of each piece, a selection
  std::vector<double> areas_;         // of the selections
  std::map<std::pair<std::uint32_t, std::uint32_t>, Sum> sums_;
  const std::uint64_t most_visits_ = kMostVisits + kMostVisitsOfAPiece * owner_.size();
  std::uint64_t visits_ = 0, found_ = 0;
};

std::string description(const Scene& scene, const Overlap& one) {
  const std::string where = one.apart == 0.0 ? "in" : "within " + text::short_number(one.apart, 1) + " of";
  return quoted(scene, one.smaller) + " lies " + where + " the plane of " + quoted(scene, one.larger) +
         " and overlaps it by " + text::short_number(one.area) + " (area)";
}

Problem words_of(const Scene& scene, std::span<const Overlap> overlaps, const std::string& effect) {
  constexpr std::size_t kShown = 4;
  std::string what;
  for (const Overlap& one : overlaps.first(std::min(kShown, overlaps.size()))) {
    what += (what.empty() ? "" : ", ") + description(scene, one);
  }
  if (overlaps.size() > kShown) what += " and " + text::counted(overlaps.size() - kShown, "more pair");
  const std::string under = overlaps.size() == 1 ? quoted(scene, overlaps.front().larger) : "what lies under it";
  return {.what = what + ": " + effect,
          .suggestion = std::string("cut ") + (overlaps.size() == 1 ? "it" : "each") + " out of " + under +
                        ", or make it a subsurface"};
}

}  // namespace

std::optional<PieceOverlap> overlap_of(const Scene& scene, const SightLines& sight, std::uint32_t a, std::uint32_t b,
                                       double reach) {
  constexpr double kNearlyParallel = 0.99;  // a millionth of a diameter leaves slim pieces some freedom
  if (std::abs(dot(sight.normal(a), sight.normal(b))) < kNearlyParallel) return std::nullopt;
  const double size_a = diameter_of(scene, a), size_b = diameter_of(scene, b);
  const std::uint32_t larger = size_a < size_b ? b : a, smaller = size_a < size_b ? a : b;
  const Plane plane(scene, sight, larger);
  const double apart = plane.distance(smaller);
  if (!(apart <= std::max(reach, kNear * std::max(size_a, size_b)))) return std::nullopt;
  const Polygon under = plane.outline(larger);
  Polygon common = plane.outline(smaller);
  const double least = 0.5 * std::min(twice_area(under), twice_area(common));
  for (std::size_t i = 0; i < under.size() && !common.empty(); ++i) {
    common = left_part(common, under[i], under[(i + 1) % under.size()]);
  }
  const double area = 0.5 * twice_area(common);
  if (!(area > kSliver * least)) return std::nullopt;
  if (are_in_one_plane(scene, scene.pieces()[a], scene.pieces()[b])) return PieceOverlap{area, 0.0};
  if (!(area > kSliverApart * least)) return std::nullopt;
  return PieceOverlap{area, std::max(apart, std::numeric_limits<double>::min())};
}

double piece_area(const Scene& scene, const SightLines& sight, std::uint32_t piece) {
  return 0.5 * twice_area(Plane(scene, sight, piece).outline(piece));
}

std::vector<Overlap> overlapping_fronts(const Scene& scene, std::span<const Selection> selections) {
  const kernel::StandardArithmetic arithmetic;
  if (selections.size() < 2) return {};
  return OverlapFinder(scene, selections).find(selections);
}

Problem warning_of_overlaps(const Scene& scene, std::span<const Overlap> overlaps) {
  return words_of(scene, overlaps, "there both count in full, and rows of a matrix exceed 1");
}

std::vector<Finding> overlap_findings(const Scene& scene, std::span<const Selection> turned) {
  const auto is_turned = [&](const Selection& patch) {
    return std::ranges::any_of(turned, [&](const Selection& one) { return one.patch == patch.patch; });
  };
  std::vector<Overlap> in_one_plane, apart;
  for (const Overlap& one : overlapping_fronts(scene, all_patches(scene))) {
    if (one.doubled || is_turned(one.smaller) || is_turned(one.larger)) continue;
    (one.apart == 0.0 ? in_one_plane : apart).push_back(one);
  }
  std::vector<Finding> findings;
  const auto add = [&](Kind kind, const std::vector<Overlap>& overlaps, Problem words) {
    Finding& finding = findings.emplace_back(Finding{.kind = kind, .words = std::move(words)});
    for (const Overlap& one : overlaps) {
      if (std::ranges::find(finding.objects, one.smaller) == finding.objects.end())
        finding.objects.push_back(one.smaller);
    }
  };
  if (!in_one_plane.empty()) add(Kind::kOverlappingFronts, in_one_plane, warning_of_overlaps(scene, in_one_plane));
  if (!apart.empty()) {
    add(Kind::kNearlyCoplanar, apart, words_of(scene, apart, "there a rounding decides which of them is seen"));
  }
  return findings;
}

}  // namespace exactff::slips
