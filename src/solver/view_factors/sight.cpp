#include "view_factors/sight.h"

#include <algorithm>
#include <map>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

constexpr std::uint32_t kByReceiver = 0, kBySource = 1;  // names of planes that clip

class Maker {
 public:
  Maker(const ExactScene& scene, std::span<const std::uint32_t> pieces)
      : scene_(scene), pieces_(pieces), sight_(scene.units) {}

  std::optional<Sight> make(const Part& receiver_part, const Part& source_part) {
    Points& points = sight_.points;
    const Ring receiver = add(receiver_part), source = add(source_part);
    corners_of_parts_ = static_cast<PointId>(points.point_count());
    sight_.receiver = plane_of(scene_, receiver_part);
    sight_.source_plane = plane_of(scene_, source_part);
    const Ring seeing = points.clip(receiver, sight_.source_plane, kBySource);
    sight_.source = points.clip(source, sight_.receiver, kByReceiver);
    if (seeing.empty() || sight_.source.empty()) return std::nullopt;
    sight_.root = cell_of(points, seeing, sight_.receiver);
    sight_.apex = std::ranges::find_if(sight_.source, [&](const Edge& edge) {
                    return side_of(sight_.receiver, points[edge.from]) > 0;
                  })->from;
    include(seeing, receiver_box_);
    include(sight_.source, source_box_);
    between_ = receiver_box_;
    between_.include(source_box_.low);
    between_.include(source_box_.high);
    shaft_.emplace(receiver_box_, source_box_);
    add_occluders();
    sight_.near_horizon = near_horizon(sight_.source);
    widen_occluders();
    points.complete();
    return std::move(sight_);
  }

  Sight make_of_open(const Part& receiver_part) {
    Points& points = sight_.points;
    const Ring receiver = add(receiver_part);
    corners_of_parts_ = static_cast<PointId>(points.point_count());
    sight_.receiver = plane_of(scene_, receiver_part);
    sight_.root = cell_of(points, receiver, sight_.receiver);
    include(receiver, receiver_box_);
    add_occluders();
    for (const Occluder& occluder : sight_.occluders) {
      for (const Edge& edge : occluder.ring) {
        if (side_of(sight_.receiver, points[edge.from]) > 0) sight_.apex = edge.from;
      }
    }
    points.complete();
    return std::move(sight_);
  }

 private:
  Ring add(const Part& part) {
    std::vector<PointId> corners;
    for (const Point& corner : part.corners) corners.push_back(id_of(corner));
    return sight_.points.ring(corners);
  }

  // The corner of the two parts at this place.
  [[nodiscard]] std::optional<PointId> corner_at(const Point& point) const {
    const auto count = std::min<PointId>(corners_of_parts_, static_cast<PointId>(sight_.points.point_count()));
    for (PointId id = 0; id < count; ++id) {
      if (sight_.points[id].exact == point.exact) return id;
    }
    return std::nullopt;
  }

  PointId id_of(const Point& point) {
    const std::optional<PointId> corner = corner_at(point);
    return corner ? *corner : sight_.points.add(point);
  }

  // A corner of the two parts keeps its identity where it is a vertex of an occluder.
  PointId vertex(std::uint32_t index) {
    const auto [place, is_new] = vertex_.try_emplace(index, 0);
    if (is_new) {
      const Point& point = scene_.vertices[index];
      const std::optional<PointId> corner = corner_at(point);
      place->second = corner ? *corner : sight_.points.refer_to(point);
    }
    return place->second;
  }

  void include(const Ring& ring, Box& box) const {
    for (const Edge& edge : ring) box.include(sight_.points[edge.from].at);
  }

  // Some of it lies in front of both planes, and perhaps in the shaft of the pair, and the pair on both sides of its
  // plane.
  [[nodiscard]] bool may_lie_between(const ExactPiece& piece) const {
    if (piece.transparent) return false;
    if (shaft_ && (piece.box.is_apart_from(between_) || shaft_->is_outside(piece.box))) return false;
    const auto has_corner_before = [&](const Plane& plane) {
      return std::ranges::any_of(piece.corners,
                                 [&](std::uint32_t corner) { return side_of(plane, scene_.vertices[corner]) > 0; });
    };
    if (!has_corner_before(sight_.receiver)) return false;
    return !shaft_ || (separates_pair(piece.plane) && has_corner_before(sight_.source_plane));
  }

  // Otherwise, almost no segment between the two crosses the plane.
  [[nodiscard]] bool separates_pair(const Plane& plane) const {
    bool before = false, behind = false;
    const auto look_at = [&](const Point& point) {
      const int side = side_of(plane, point);
      before = before || side > 0;
      behind = behind || side < 0;
      return before && behind;
    };
    return std::ranges::any_of(sight_.root.corners, look_at) ||
           std::ranges::any_of(sight_.source, [&](const Edge& e) { return look_at(sight_.points[e.from]); });
  }

  // Heights err by less than 2^-46, so where the other end of the side before is so many times as high, this side falls
  // towards the plane, and meets it at less than kFlat of its length beyond. Likewise the side after. A convex
  // polygon has no more than one such place. No coordinate may exceed 1.
  std::optional<NearHorizon> near_horizon(const Ring& ring) {
    constexpr double kFlat = 0x1p-8, kHigh = 0x1p-24;
    const Side above = Side::of(sight_.receiver);
    double highest = 0.0;
    std::vector<double> heights;
    for (const Edge& side : ring) heights.push_back(above.height(sight_.points[side.from].at));
    for (const double height : heights) highest = std::max(highest, height);
    if (highest < kHigh) return std::nullopt;
    const std::size_t n = ring.size();
    const auto is_low = [&](std::size_t corner) { return heights[corner % n] < kFlat * highest; };
    for (std::size_t i = 0; i < n; ++i) {
      if (is_low(i) || !is_low(i + 1)) continue;
      std::size_t count = 0;
      while (is_low(i + count + 2)) ++count;
      const Edge &before = ring[i], &after = ring[(i + count + 1) % n];
      const bool is_steep = std::max(heights[(i + 1) % n], heights[(i + count + 1) % n]) <
                            kFlat * std::min(heights[i], heights[(i + count + 2) % n]);
      bool is_in_plane = true;
      for (std::size_t k = 1; k <= count + 1; ++k) {
        is_in_plane = is_in_plane && side_of(sight_.receiver, sight_.points[ring[(i + k) % n].from]) == 0;
      }
      if (count == 0 || !is_steep || is_in_plane) return std::nullopt;
      const Edge in_plane = sight_.points.between_crossings(before, after, sight_.receiver, kByReceiver);
      if (!is_beyond(in_plane, before.to, after.from)) return std::nullopt;
      return NearHorizon{(i + 1) % n, count, in_plane};
    }
    return std::nullopt;
  }

  void widen_occluders() {
    for (std::uint32_t o = 0; o < sight_.occluders.size(); ++o) {
      const Occluder& occluder = sight_.occluders[o];
      const std::optional<NearHorizon> near = near_horizon(occluder.ring);
      if (!near) continue;
      Ring ring;
      const std::size_t n = occluder.ring.size();
      for (std::size_t k = near->count; k < n; ++k) ring.push_back(occluder.ring[(near->first + k) % n]);
      ring.front().from = near->in_plane.to;
      ring.back().to = near->in_plane.from;
      ring.push_back(near->in_plane);
      sight_.widened.push_back({o, *near, {std::move(ring), occluder.plane}});
    }
  }

  // Whether it leads as these corners do, and its ends are near them, in coordinates of at most 1.
  [[nodiscard]] bool is_beyond(const Edge& edge, PointId from, PointId to) const {
    const Vec3 &a = sight_.points[from].at, &b = sight_.points[to].at, &c = sight_.points[edge.from].at,
               &d = sight_.points[edge.to].at;
    const double least = 0.25 * kernel::distance(a, b);
    return kernel::distance(a, c) < least && kernel::distance(b, d) < least &&
           std::max(kernel::max_norm(c), kernel::max_norm(d)) <= 1.0;
  }

  // The index in Sight::solids; see the header.
  std::uint32_t solid(std::uint32_t surface) {
    if (surface == kNoSurface) return kNoSolid;
    const auto [place, is_new] = solid_of_.try_emplace(surface, kNoSolid);
    if (!is_new || !may_be_solid(scene_.surfaces[surface])) return place->second;
    place->second = static_cast<std::uint32_t>(sight_.solids.size());
    sight_.solids.push_back({scene_.surfaces[surface].turned_inside_out, bases_of(scene_.surfaces[surface])});
    return place->second;
  }

  [[nodiscard]] bool may_be_solid(const ExactSurface& surface) const {
    return (!shaft_ || surface.box.is_apart_from(source_box_) || stands_on_source(surface)) &&
           (surface.box.is_apart_from(receiver_box_) || lies_before(surface, sight_.receiver));
  }

  [[nodiscard]] bool lies_before(const ExactSurface& surface, const Plane& plane) const {
    return std::ranges::all_of(surface.pieces, [&](std::uint32_t piece) {
      return std::ranges::all_of(scene_.pieces[piece].corners,
                                 [&](std::uint32_t corner) { return side_of(plane, scene_.vertices[corner]) >= 0; });
    });
  }

  // In front of the source's plane, or in it and facing away. Planes are primitive, so equal ones face the same side.
  [[nodiscard]] bool stands_on_source(const ExactSurface& surface) const {
    const Homogeneous towards =
        surface.turned_inside_out ? opposite(sight_.source_plane.exact) : sight_.source_plane.exact;
    return lies_before(surface, sight_.source_plane) && std::ranges::none_of(surface.pieces, [&](std::uint32_t piece) {
             return scene_.pieces[piece].plane.exact == towards;
           });
  }

  std::vector<Ring> bases_of(const ExactSurface& surface) {
    std::vector<Ring> bases;
    if (surface.box.is_apart_from(receiver_box_)) return bases;
    const Homogeneous& front = sight_.receiver.exact;
    const Homogeneous back = opposite(front);
    for (const std::uint32_t id : surface.pieces) {
      const ExactPiece& piece = scene_.pieces[id];
      if (piece.plane.exact == front) bases.push_back(ring_of(piece));
      if (piece.plane.exact == back) bases.push_back(reverse_of(ring_of(piece)));
    }
    return bases;
  }

  Ring ring_of(const ExactPiece& piece) {
    std::vector<PointId> corners;
    for (const std::uint32_t corner : piece.corners) corners.push_back(vertex(corner));
    return sight_.points.ring(corners);
  }

  // Instead of the pieces of a sheet, all of its panels: also those parts that are not seen are there.
  void add_occluders() {
    const Panels& panels = exactff::panels(scene_.scene);
    std::vector<bool> is_added(panels.sheets().size());
    for (const std::uint32_t piece : pieces_) {
      const std::uint32_t index = panels.sheet_of_piece(piece);
      if (index == Panels::kNoSheet) {
        add_occluder(scene_.pieces[piece]);
      } else if (!is_added[index]) {
        is_added[index] = true;
        const Sheet& sheet = panels.sheets()[index];
        for (PanelId k = 0; k < sheet.panel_count; ++k) add_occluder(scene_.panel(sheet.first_panel + k));
      }
    }
  }

  void add_occluder(const ExactPiece& piece) {
    if (!may_lie_between(piece)) return;
    Points& points = sight_.points;
    const Ring above = points.clip(ring_of(piece), sight_.receiver, kByReceiver);
    if (above.empty()) return;
    Ring ring = shaft_ ? points.clip(above, sight_.source_plane, kBySource) : above;
    if (!ring.empty()) sight_.occluders.push_back({std::move(ring), &piece.plane, solid(piece.surface)});
  }

  const ExactScene& scene_;
  std::span<const std::uint32_t> pieces_;
  Sight sight_;
  Box receiver_box_, source_box_, between_;
  std::optional<PairShaft> shaft_;  // if there is a source
  PointId corners_of_parts_ = std::numeric_limits<PointId>::max();
  std::map<std::uint32_t, PointId> vertex_;
  std::map<std::uint32_t, std::uint32_t> solid_of_;  // by surface
};

}  // namespace

const Plane& plane_of(const ExactScene& scene, const Part& part) { return scene.panel(part.panel).plane; }

std::vector<FaceId> faces_of(const Scene& scene, const Part& part) {
  const Panels& all = panels(scene);
  if (!all.is_joined(part.panel)) return {part.face};
  std::vector<FaceId> faces;
  for (const std::uint32_t piece : all.sheet_of(part.panel).pieces) {
    const FaceId face = scene.pieces()[piece].face;
    if (faces.empty() || faces.back() != face) faces.push_back(face);
  }
  return faces;
}

std::optional<Sight> sight_of(const ExactScene& scene, std::span<const std::uint32_t> pieces, const Part& receiver,
                              const Part& source) {
  return Maker(scene, pieces).make(receiver, source);
}

Sight sight_of_open(const ExactScene& scene, std::span<const std::uint32_t> pieces, const Part& receiver) {
  return Maker(scene, pieces).make_of_open(receiver);
}

// --- Pair shaft ---

namespace {

constexpr double kShaftMargin = 0x1p-44;

}  // namespace

// Sides of the hull in two axes that are no sides of a box join corresponding corners of the two.
PairShaft::PairShaft(const Box& a, const Box& b) {
  using kernel::coordinate;
  for (int u = 0; u < 3; ++u) {
    const int v = (u + 1) % 3;
    for (const bool low_u : {true, false}) {
      for (const bool low_v : {true, false}) {
        const auto corner = [&](const Box& box) {
          return std::array{coordinate(low_u ? box.low : box.high, u), coordinate(low_v ? box.low : box.high, v)};
        };
        const std::array<double, 2> p = corner(a), q = corner(b);
        for (const double sign : {1.0, -1.0}) {
          HalfSpace side{u, v, {sign * (q[1] - p[1]), -sign * (q[0] - p[0])}, p, 0.0};
          side.limit = std::max(extreme(side, a, 1), extreme(side, b, 1)) + kShaftMargin;
          if (side.limit <= 2.0 * kShaftMargin && side.normal != std::array{0.0, 0.0}) half_spaces_.push_back(side);
        }
      }
    }
  }
}

double PairShaft::extreme(const HalfSpace& half_space, const Box& box, int sign) {
  const auto along = [&](int axis, std::size_t i) {
    const double low = half_space.normal[i] * (kernel::coordinate(box.low, axis) - half_space.origin[i]);
    const double high = half_space.normal[i] * (kernel::coordinate(box.high, axis) - half_space.origin[i]);
    return sign > 0 ? std::max(low, high) : std::min(low, high);
  };
  return along(half_space.first, 0) + along(half_space.second, 1);
}

bool PairShaft::is_outside(const Box& box) const {
  return std::ranges::any_of(half_spaces_,
                             [&](const HalfSpace& side) { return extreme(side, box, -1) > side.limit + kShaftMargin; });
}

}  // namespace exactff::view_factors
