#include "view_factors/sight.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <map>

namespace exactff::view_factors {
namespace {

constexpr std::uint32_t kByReceiver = 0, kBySource = 1;  // names of planes that clip

class Maker {
 public:
  Maker(const ExactScene& scene, FaceId own) : scene_(scene), own_(own), sight_(scene.units) {}

  std::optional<Sight> make(const Part& receiver_part, const Part& source_part) {
    Points& points = sight_.points;
    const Ring receiver = add(receiver_part), source = add(source_part);
    corners_of_parts_ = static_cast<PointId>(points.point_count());
    sight_.receiver = points.plane_of(receiver);
    source_plane_ = points.plane_of(source);
    const Ring seeing = points.clipped(receiver, source_plane_, kBySource);
    sight_.source = points.clipped(source, sight_.receiver, kByReceiver);
    if (seeing.empty() || sight_.source.empty()) return std::nullopt;
    sight_.root = cell_of(points, seeing, sight_.receiver);
    for (const Ring* ring : std::initializer_list<const Ring*>{&seeing, &sight_.source}) {
      for (const Edge& edge : *ring) between_.include(points[edge.from].at);
    }
    for (const ExactPiece& piece : scene_.pieces) add_occluder(piece);
    points.complete();
    return std::move(sight_);
  }

 private:
  Ring add(const Part& part) {
    std::vector<PointId> corners;
    for (const Point& corner : part.corners) corners.push_back(known(corner));
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

  PointId known(const Point& point) {
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

  // Some of it lies in front of both planes, and in the box of the pair.
  [[nodiscard]] bool may_lie_between(const ExactPiece& piece) const {
    if (piece.transparent || piece.face == own_ || piece.box.is_apart_from(between_)) return false;
    const auto has_corner_before = [&](const Plane& plane) {
      return std::ranges::any_of(piece.corners,
                                 [&](std::uint32_t corner) { return side_of(plane, scene_.vertices[corner]) > 0; });
    };
    return has_corner_before(sight_.receiver) && has_corner_before(source_plane_);
  }

  void add_occluder(const ExactPiece& piece) {
    if (!may_lie_between(piece)) return;
    std::vector<PointId> corners;
    for (const std::uint32_t corner : piece.corners) corners.push_back(vertex(corner));
    Points& points = sight_.points;
    const Ring above = points.clipped(points.ring(corners), sight_.receiver, kByReceiver);
    if (above.empty()) return;
    Ring ring = points.clipped(above, source_plane_, kBySource);
    if (!ring.empty()) sight_.occluders.push_back({std::move(ring), &piece.plane});
  }

  const ExactScene& scene_;
  FaceId own_;
  Sight sight_;
  Plane source_plane_;
  Box between_;
  PointId corners_of_parts_ = std::numeric_limits<PointId>::max();
  std::map<std::uint32_t, PointId> vertex_;
};

}  // namespace

std::optional<Sight> sight_of(const ExactScene& scene, const Part& receiver, const Part& source, FaceId own) {
  return Maker(scene, own).make(receiver, source);
}

}  // namespace exactff::view_factors
