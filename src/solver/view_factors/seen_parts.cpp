#include "view_factors/seen_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "kernel/poll.h"
#include "kernel/vec.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

// --- Enclosures ---

namespace {

// Directions that few edges meet. If all of them meet some, nothing is proved.
constexpr std::array<std::array<int, 3>, 6> kDirections{
    {{71, 37, 53}, {-43, 67, 59}, {61, -73, 47}, {41, 79, -31}, {-83, -29, 89}, {97, -19, -23}}};

int sign_of_dot(const Plane& plane, const std::array<int, 3>& direction) {
  Integer sum;
  for (std::size_t i = 0; i < 3; ++i) sum += plane.exact[i] * direction[i];
  return sgn(sum);
}

// From just above a point of a plane on, in a direction: back through the point, if the direction leads below the
// plane.
class Ray {
 public:
  Ray(const Point& from, const std::array<int, 3>& direction, bool leads_below)
      : from_(from), direction_(direction), leads_below_(leads_below) {
    for (std::size_t i = 0; i < 3; ++i) to_.exact[i] = direction[i];  // the point at infinity
  }

  // +1: it crosses the piece from the back to the front; -1: the other way; 0: it does not meet it. Empty if it meets
  // the piece's edge or runs in its plane.
  [[nodiscard]] std::optional<int> crossing(const ExactScene& scene, const ExactPiece& piece) const {
    if (misses(piece.box)) return 0;
    const int from = side_of(piece.plane, from_), towards = sign_of_dot(piece.plane, direction_);
    if (from == 0 && towards == 0) return std::nullopt;
    if (from * towards > 0 || (from == 0 && !leads_below_)) return 0;
    bool has_left = false, has_right = false, meets_line = false;
    for (std::size_t i = 0; i < piece.corners.size(); ++i) {
      const Point &p = scene.vertices[piece.corners[i]],
                  &q = scene.vertices[piece.corners[i + 1 == piece.corners.size() ? 0 : i + 1]];
      const int side = side_of_edge(p, q);
      has_left = has_left || side > 0;
      has_right = has_right || side < 0;
      meets_line = meets_line || side == 0;
    }
    if (has_left && has_right) return 0;
    if (meets_line) return std::nullopt;
    return towards;
  }

 private:
  // Certainly: the slabs of the box are widened by far more than all roundings, since no coordinate exceeds 1.
  [[nodiscard]] bool misses(const Box& box) const {
    constexpr double kGap = 0x1p-40;
    double first = 0.0, last = Box::kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = kernel::coordinate(from_.at, axis), step = direction_[static_cast<std::size_t>(axis)];
      const double low = kernel::coordinate(box.low, axis) - kGap - at,
                   high = kernel::coordinate(box.high, axis) + kGap - at;
      first = std::max(first, (step > 0.0 ? low : high) / step);
      last = std::min(last, (step > 0.0 ? high : low) / step);
    }
    return first > last;
  }

  // The sign of det(from, to, p, q).
  [[nodiscard]] int side_of_edge(const Point& p, const Point& q) const {
    const Homogeneous plane = join(from_, to_, p);
    Integer sum;
    for (std::size_t i = 0; i < 4; ++i) sum += plane[i] * q.exact[i];
    return sgn(sum);
  }

  const Point& from_;
  const std::array<int, 3>& direction_;
  const bool leads_below_;
  Point to_;
};

using Strips = std::vector<ExactPiece>;

// Of a surface and its strips, if it has any.
template <class Test>
bool all_of(const ExactScene& scene, const ExactSurface& surface, const Strips& strips, const Test& test) {
  return std::ranges::all_of(surface.pieces, [&](std::uint32_t piece) { return test(scene.pieces[piece]); }) &&
         std::ranges::all_of(strips, test);
}

// On the ray, near its start.
std::optional<int> winding_number(const ExactScene& scene, const ExactSurface& surface, const Strips& strips,
                                  const Ray& ray) {
  int sum = 0;
  const bool is_known = all_of(scene, surface, strips, [&](const ExactPiece& piece) {
    const std::optional<int> crossing = ray.crossing(scene, piece);
    sum += crossing.value_or(0);
    return crossing.has_value();
  });
  return is_known ? std::optional(sum) : std::nullopt;
}

// The centre of three corners.
Point inner_point(const Part& part, const Units& units) {
  Homogeneous sum{0, 0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const Homogeneous &corner = part.corners[i].exact, &second = part.corners[(i + 1) % 3].exact,
                      &third = part.corners[(i + 2) % 3].exact;
    const Integer others = second[3] * third[3];
    for (std::size_t k = 0; k < 3; ++k) sum[k] += corner[k] * others;
    sum[3] = 3 * corner[3] * others;
  }
  return make_point(std::move(sum), units);
}

// Whether some of the points lie in front of the plane, and some behind it.
template <class Points, class PointOf = std::identity>
std::pair<bool, bool> sides_of(const Plane& plane, const Points& points, PointOf point_of = {}) {
  std::pair<bool, bool> found{false, false};
  for (const auto& point : points) {
    const int side = side_of(plane, point_of(point));
    found.first = found.first || side > 0;
    found.second = found.second || side < 0;
  }
  return found;
}

// Of a part.
class Interior {
 public:
  Interior(const ExactScene& scene, const Part& part)
      : scene_(scene),
        part_(part),
        plane_(plane_of(scene, part)),
        box_(box_of(part.corners)),
        centre_(inner_point(part, scene.units)) {
    for (std::size_t i = 0; i < part.corners.size(); ++i) {
      const Point &p = part.corners[i], &q = part.corners[i + 1 == part.corners.size() ? 0 : i + 1];
      Point normal;
      for (std::size_t k = 0; k < 3; ++k) normal.exact[k] = plane_.exact[k];  // at infinity
      edges_.push_back(make_plane(join(p, q, normal), scene.units));
    }
    for (Plane& edge : edges_) {
      if (side_of(edge, centre_) < 0) edge = make_plane(opposite(edge.exact), scene.units);
    }
  }

  // Just above all of it, if that is known.
  [[nodiscard]] std::optional<int> winding(const ExactSurface& surface, const Strips& strips = {}) const {
    if (surface.rim && !lies_before(*surface.rim)) return std::nullopt;
    if (surface.box.is_apart_from(box_)) return 0;
    const auto is_off = [&](const ExactPiece& piece) { return keeps_off(piece); };
    if (!all_of(scene_, surface, strips, is_off)) return std::nullopt;
    for (std::array<int, 3> direction : kDirections) {
      for (const int way : {1, -1}) {
        for (int& component : direction) component *= way;
        const int upwards = sign_of_dot(plane_, direction);
        if (upwards == 0 || (surface.rim && sign_of_dot(*surface.rim, direction) <= 0)) continue;
        const Ray ray(centre_, direction, upwards < 0);
        if (const std::optional<int> w = winding_number(scene_, surface, strips, ray)) return w;
      }
    }
    return std::nullopt;
  }

 private:
  // And what is just above it.
  [[nodiscard]] bool lies_before(const Plane& plane) const {
    const auto [some_before, some_behind] = sides_of(plane, part_.corners);
    if (some_before || some_behind) return !some_behind;
    Integer cosine;
    for (std::size_t i = 0; i < 3; ++i) cosine += plane.exact[i] * plane_.exact[i];
    return sgn(cosine) > 0;
  }
  // See the header.
  [[nodiscard]] bool keeps_off(const ExactPiece& piece) const {
    if (piece.box.is_apart_from(box_)) return true;
    const auto point_of = [&](std::uint32_t corner) -> const Point& { return scene_.vertices[corner]; };
    const auto [is_in_front, is_behind] = sides_of(plane_, piece.corners, point_of);
    const auto [part_in_front, part_behind] = sides_of(piece.plane, part_.corners);
    if (!is_in_front || part_in_front != part_behind) return true;
    const bool is_whole = is_behind;  // else its corners in the plane count
    return std::ranges::any_of(edges_, [&](const Plane& edge) {
      return std::ranges::none_of(piece.corners, [&](std::uint32_t corner) {
        return side_of(edge, point_of(corner)) > 0 && (is_whole || side_of(plane_, point_of(corner)) == 0);
      });
    });
  }

  const ExactScene& scene_;
  const Part& part_;
  const Plane& plane_;
  Box box_;
  Point centre_;              // inside
  std::vector<Plane> edges_;  // through the edges, along the normal; positive inside
};

}  // namespace

Enclosures::Enclosures(const ExactScene& scene)
    : scene_(scene),
      surfaces_(exact_surfaces(ClosedSurfaces(scene.scene, ClosedSurfaces::Edges::kCutAtJunctions), scene.pieces,
                               scene.units)) {}

Windings Enclosures::above(const Part& part) const {
  Windings windings(surfaces_.size());
  if (surfaces_.empty()) return windings;
  const Interior interior(scene_, part);
  std::ranges::transform(surfaces_, windings.begin(), [&](const ExactSurface& surface) {
    kernel::poll();
    return interior.winding(surface);
  });
  return windings;
}

bool Enclosures::are_around(const Windings& windings) const {
  for (std::size_t i = 0; i < windings.size(); ++i) {
    if (!surfaces_[i].rim && windings[i] && *windings[i] != 0) return true;
  }
  return false;
}

// --- Almost closed surfaces ---

namespace {

constexpr double kSpace = 4.0;                // times what was moved, from the part's sides
constexpr double kLeastSpace = 0x1p-40;       // in the unit of Point::at
constexpr double kOverRounded = 1 + 0x1p-30;  // more than those of areas and of their sums

// The part towards one of its points: by 2^-60 times an integer of its distance, at least as far from each side as is
// asked for. With how much of the area is left out, or more; empty if this is much.
std::optional<std::pair<Part, double>> inner_part(const Part& part, double space, const Units& units) {
  constexpr int kBits = 60;
  constexpr double kMost = 0.25;
  const Point centre = inner_point(part, units);
  double nearest = Box::kInfinity;
  for (std::size_t i = 0; i < part.corners.size(); ++i) {
    const Vec3 &a = part.corners[i].at, &b = part.corners[(i + 1) % part.corners.size()].at;
    nearest = std::min(nearest, distance_to_segment(centre.at, a, b));
  }
  const double steps = std::ceil(std::ldexp(space / nearest, kBits)), share = std::ldexp(steps, -kBits);
  if (!(share < kMost)) return std::nullopt;
  const Integer whole = Integer(1) << kBits, towards(steps);
  Part inner = part;
  for (Point& corner : inner.corners) {
    Homogeneous at;
    const Integer of_corner = centre.exact[3] * (whole - towards), of_centre = corner.exact[3] * towards;
    for (std::size_t k = 0; k < 3; ++k) at[k] = corner.exact[k] * of_corner + centre.exact[k] * of_centre;
    at[3] = corner.exact[3] * centre.exact[3] * whole;
    corner = make_point(std::move(at), units);
  }
  return std::pair(std::move(inner), 2.0 * share * area(positions_of(part.corners)));
}

}  // namespace

double open_at_most(const ExactScene& scene, const std::vector<AlmostClosedSurface>& surfaces,
                    std::span<const Part> parts) {
  std::vector<bool> is_around(surfaces.size());
  double sum = 0.0;
  for (const Part& part : parts) {
    kernel::poll();
    double open = area(positions_of(part.corners));
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const AlmostClosedSurface& closed = surfaces[s];
      if (closed.surface.box.is_apart_from(box_of(part.corners))) continue;
      const auto inner = inner_part(part, kSpace * closed.moved + kLeastSpace, scene.units);
      if (!inner || Interior(scene, inner->first).winding(closed.surface, closed.strips).value_or(0) == 0) continue;
      is_around[s] = true;
      open = inner->second;
      break;
    }
    sum += open;
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) sum += is_around[s] ? surfaces[s].area_of_strips : 0.0;
  return sum * kOverRounded;
}

bool are_separated(const Windings& one, const Windings& other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (one[i] && other[i] && *one[i] != *other[i]) return true;
  }
  return false;
}

// --- Seen parts ---

namespace {

constexpr std::size_t kFewQuestions = 4;  // of a part: more cost as much as its list

// Of the part's face, or sheet, ascending.
std::vector<std::uint32_t> pieces_of(const Scene& scene, const Part& part) {
  if (const Panels& all = panels(scene); all.is_joined(part.panel)) {
    return all.sheet_of(part.panel).pieces;
  }
  const Face& face = scene.face(part.face);
  std::vector<std::uint32_t> pieces(face.piece_count);
  std::iota(pieces.begin(), pieces.end(), face.first_piece);
  return pieces;
}

}  // namespace

SeenParts::SeenParts(const ExactScene& scene) : scene_(scene), walls_(visibility::walls_of(scene.scene)) {}

const SeenParts::Lists& SeenParts::OfPatch::lists(const SeenParts& scene, std::span<const Part> parts) const {
  std::call_once(state_->once, [&] {
    Lists lists;
    for (const Part& part : parts) lists.push_back(scene.seen_from(part));
    state_->lists = std::move(lists);
  });
  return state_->lists;
}

bool SeenParts::OfPatch::sees(const SeenParts& scene, std::span<const Part> parts, std::size_t i,
                              const Part& other) const {
  const std::vector<std::uint32_t> pieces = pieces_of(scene.scene_.scene, other);
  if (state_->questions++ < kFewQuestions * parts.size()) {
    return visibility::sees_any_of(scene.scene_.scene, scene.walls_, scene.region_of(parts[i]), pieces);
  }
  const std::vector<std::uint32_t>& seen = lists(scene, parts)[i].seen;
  return std::ranges::any_of(pieces, [&](std::uint32_t piece) { return std::ranges::binary_search(seen, piece); });
}

const std::vector<Windings>& SeenParts::OfPatch::windings(const SeenParts& scene, std::span<const Part> parts) const {
  std::call_once(state_->windings_once, [&] {
    std::vector<Windings> windings;
    for (const Part& part : parts) windings.push_back(scene.enclosures().above(part));
    state_->windings = std::move(windings);
  });
  return state_->windings;
}

const Enclosures& SeenParts::enclosures() const {
  std::call_once(enclosures_once_, [&] { enclosures_.emplace(scene_); });
  return *enclosures_;
}

const std::vector<AlmostClosedSurface>& SeenParts::almost_closed() const {
  std::call_once(almost_closed_once_, [&] { almost_closed_ = almost_closed_surfaces(scene_); });
  return almost_closed_;
}

// Corners of a part may be rounded; those of its face, or of its joined panel, are not.
exactff::Box SeenParts::region_of(const Part& part) const {
  const Scene& scene = scene_.scene;
  const Panels& panels = exactff::panels(scene);
  const std::span<const std::uint32_t> ring =
      panels.is_joined(part.panel) ? panels.corners(part.panel) : scene.face(part.face).rings.front();
  exactff::Box box{scene.vertices()[ring.front()], scene.vertices()[ring.front()]};
  for (const std::uint32_t corner : ring) box.include(scene.vertices()[corner]);
  return box;
}

SeenPieces SeenParts::seen_from(const Part& part) const {
  const Scene& scene = scene_.scene;
  SeenPieces result{visibility::pieces_seen_from(scene, walls_, region_of(part)), {}};
  std::ranges::sort(result.seen);
  std::vector<bool> occludes(scene.pieces().size());
  for (const std::uint32_t piece : result.seen) {
    occludes[piece] = true;
    const std::uint32_t surface = scene_.pieces[piece].surface;
    if (surface == kNoSurface) continue;
    for (const std::uint32_t other : scene_.surfaces[surface].pieces) occludes[other] = true;
  }
  for (std::uint32_t piece = 0; piece < occludes.size(); ++piece) {
    if (occludes[piece]) result.occluders.push_back(piece);
  }
  return result;
}

}  // namespace exactff::view_factors
