#include "adaptive/receiver_view.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "adaptive/plane_side.h"
#include "kernel/exact_vec.h"
#include "kernel/vec.h"
#include "scene/misuse.h"

namespace exactff::adaptive {

namespace {

// The power of two that brings the largest of the values into [1/2, 1).
double normalising_scale(double largest) {
  return largest > 0.0 ? std::ldexp(1.0, -std::clamp(std::ilogb(largest) + 1, -1022, 1022)) : 1.0;
}

// The shaft of one polygon: half-spaces for the query of the tree, then the same tests for each piece.
class Gatherer {
 public:
  Gatherer(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane, Horizon horizon,
           Gathered& scratch)
      : scene_(scene),
        view_(view),
        plane_(plane),
        horizon_(horizon),
        front_(plane_normal(plane.frame[0], plane.frame[1], plane.frame[2])),
        above_(exact_normal(view.normal)),
        extent_(2.0 + max_norm(view.point)),
        half_spaces_(scratch.half_spaces),
        seen_(scratch.seen) {}

  // The polygon's sides, the plane of the source, the plane through x parallel to it, and the horizon.
  std::span<const HalfSpace> shaft(std::span<const Vec3> polygon) {
    half_spaces_.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 edge = polygon[i + 1 < polygon.size() ? i + 1 : 0] - polygon[i];
      add(cross(edge, polygon[i]), 2.0 * max_norm(edge) * max_norm(polygon[i]), 0.0);
    }
    const Vec3 to_plane = plane_.frame[0] - view_.point;
    const double magnitude = max_norm(front_.magnitude);
    add(front_.value, magnitude * (1.0 + max_norm(to_plane)), dot(front_.value, to_plane));
    add(-front_.value, magnitude, 0.0);
    if (horizon_ == Horizon::kClips) half_spaces_.push_back({view_.normal, 0.0});
    return half_spaces_;
  }

  // True if the plane of the last seen piece is too near x, or that piece too near the source's plane, for single
  // precision.
  [[nodiscard]] bool is_blurred(double blur) const {
    const Vec3& normal = seen_.normal.value;
    if (std::abs(dot(normal, seen_.corners[0])) <= blur * length(normal)) return true;
    const Vec3 to_plane = plane_.frame[0] - view_.point;
    return std::all_of(seen_.corners.begin(), seen_.corners.end(), [&](const Vec3& t) {
      return std::abs(dot(front_.value, t - to_plane)) <= blur * length(front_.value);
    });
  }

  // The piece as x sees it, or null if it certainly hides nothing.
  const SeenPolygon* see(std::uint32_t index) {
    const Piece& piece = scene_.scene->pieces()[index];
    if (piece.transparent || view_.is_own(index)) return nullptr;
    if (std::binary_search(plane_.coplanar.begin(), plane_.coplanar.end(), index)) return nullptr;
    corners_ = scene_.scene->corners(piece);
    if (outside_slab()) return nullptr;
    const std::vector<Vec3>& p = scene_.points;
    const Normal front = plane_normal(p[piece.frame[0]], p[piece.frame[1]], p[piece.frame[2]]);
    const int side = side_of_x(view_, scene_, piece, front);
    if (side == 0) return nullptr;
    copy_corners();
    seen_.normal = {-front.value, front.magnitude};
    if (side < 0) seen_.reverse();
    return &seen_;
  }

 private:
  // A rounded normal n' represents an n within 2^-50 of its magnitude, so n . d >= 0 implies only
  // n' . d >= -3 * 2^-50 * magnitude * |d|: the offset is relaxed by more than that.
  void add(const Vec3& normal, double magnitude, double offset) {
    half_spaces_.push_back({normal, offset - 0x1p-47 * magnitude * extent_});
  }

  template <class Height>
  [[nodiscard]] bool no_corner_above(const Height& height) const {
    return std::none_of(corners_.begin(), corners_.end(),
                        [&](std::uint32_t v) { return !height(scene_.points[v]).certainly_not_positive(); });
  }

  // The whole piece lies on or behind the source's plane, on or behind the plane through x, or on or below the horizon.
  [[nodiscard]] bool outside_slab() const {
    return no_corner_above([&](const Vec3& p) { return bounded_dot(front_, p - plane_.frame[0]); }) ||
           no_corner_above([&](const Vec3& p) { return bounded_dot(front_, view_.point - p); }) ||
           (horizon_ == Horizon::kClips &&
            no_corner_above([&](const Vec3& p) { return bounded_dot(above_, p - view_.point); }));
  }

  void copy_corners() {
    seen_.corners.clear();
    seen_.edges.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Vec3& p = scene_.points[corners_[i]];
      seen_.corners.push_back(p - view_.point);
      seen_.edges.push_back(scene_.points[corners_[i + 1 < corners_.size() ? i + 1 : 0]] - p);
    }
  }

  const ScaledScene& scene_;
  const ReceiverView& view_;
  const SourcePlane& plane_;
  Horizon horizon_;
  Normal front_;
  Normal above_;
  double extent_;  // bounds the max norm of any scene point's distance from x, and 1
  std::vector<HalfSpace>& half_spaces_;
  SeenPolygon& seen_;
  std::span<const std::uint32_t> corners_;
};

}  // namespace

ScaledScene::ScaledScene(const Scene& scene_given) : scene(&scene_given) {
  const auto vertices = scene->vertices();
  double largest = 0.0;
  for (const Vec3& v : vertices) largest = std::max(largest, max_norm(v));
  scale = normalising_scale(largest);
  points.reserve(vertices.size());
  for (const Vec3& v : vertices) points.push_back(v * scale);
  std::vector<Box> boxes;
  for (const Piece& piece : scene->pieces()) boxes.push_back(bounds_of(points, scene->corners(piece)));
  tree = ShaftTree(boxes);
}

Box bounds_of(const std::vector<Vec3>& points, std::span<const std::uint32_t> indices) {
  Box box{points[indices[0]], points[indices[0]]};
  for (const std::uint32_t i : indices) box.include(points[i]);
  return box;
}

ReceiverView view_from(const Receiver& receiver, const ScaledScene& scene) {
  for (const FaceId face : receiver.on) require_face(*scene.scene, face);
  if (!kernel::is_finite(receiver.point) || !kernel::is_finite(receiver.normal)) {
    throw InputError(Problem{{},
                             0,
                             "receiver '" + receiver.id + "' has a coordinate that is not finite",
                             "no form factor is defined there",
                             {}});
  }
  if (receiver.normal == Vec3{}) {
    throw InputError(Problem{{},
                             0,
                             "receiver '" + receiver.id + "' has a normal of length 0",
                             "it has no horizon",
                             "give a normal of any other length"});
  }
  ReceiverView view{receiver.point, receiver.point * scene.scale, {}, {}, {*scene.scene, receiver}};
  view.normal = receiver.normal * normalising_scale(max_norm(receiver.normal));
  view.unit_normal = view.normal * (1.0 / length(view.normal));
  return view;
}

std::uint64_t stream_key(const ReceiverView& view, const Selection& source, std::uint64_t seed) {
  const auto bits_of = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };  // -0 is 0
  std::uint64_t key = kernel::split_mix(seed, 0);
  for (const Vec3& v : {view.exact_point, view.normal}) {
    for (const double value : {v.x, v.y, v.z}) key = kernel::split_mix(key, bits_of(value));
  }
  key = kernel::split_mix(key, index_of(source.patch));
  return kernel::split_mix(key, source.face ? index_of(*source.face) + 1 : 0);
}

bool in_front(const ReceiverView& view, const SourcePlane& plane) {
  const Normal normal = plane_normal(plane.frame[0], plane.frame[1], plane.frame[2]);
  const Bounded height = bounded_dot(normal, view.point - plane.frame[0]);
  if (height.certainly_positive()) return true;
  if (height.certainly_not_positive()) return false;
  const std::array<Vec3, 3>& f = plane.exact_frame;
  return kernel::orientation(f[0], f[1], f[2], view.exact_point) > 0;
}

int side_of_x(const ReceiverView& view, const ScaledScene& scene, const Piece& piece, const Normal& front) {
  const Bounded height = bounded_dot(front, view.point - scene.points[piece.frame[0]]);
  if (height.certainly_positive()) return 1;
  if (height.certainly_negative()) return -1;
  if (height.certainly_zero()) return 0;
  const auto vertices = scene.scene->vertices();
  return kernel::orientation(vertices[piece.frame[0]], vertices[piece.frame[1]], vertices[piece.frame[2]],
                             view.exact_point);
}

namespace {

void start(Gathered& gathered) {
  gathered.occluders.clear();
  gathered.sharp_pieces.clear();
  gathered.blurred.clear();
  gathered.looked_at = 0;
}

double reach_of(std::span<const Vec3> polygon) {
  double reach = 0.0;
  for (const Vec3& p : polygon) reach = std::max(reach, max_norm(p));
  return reach;
}

void add_blurred(const SeenPolygon& seen, double reach, Gathered& gathered) {
  gathered.blurred.push_back(static_cast<std::uint32_t>(gathered.occluders.size()));
  gathered.occluders.add(seen, reach);
}

}  // namespace

bool gather_occluders(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane,
                      std::span<const Vec3> polygon, Horizon horizon, double blur, Gathered& gathered,
                      std::size_t most) {
  start(gathered);
  Gatherer gatherer(scene, view, plane, horizon, gathered);
  const double reach = reach_of(polygon);
  scene.tree.query(view.point, gatherer.shaft(polygon), [&](std::uint32_t piece) {
    if (scene.scene->pieces()[piece].transparent) return true;
    ++gathered.looked_at;
    if (gathered.looked_at > most) return false;
    const SeenPolygon* seen = gatherer.see(piece);
    if (seen == nullptr) return true;
    if (gatherer.is_blurred(blur)) {
      add_blurred(*seen, reach, gathered);
    } else {
      gathered.sharp_pieces.push_back(piece);
      gathered.occluders.add(*seen, reach);
    }
    return true;
  });
  return gathered.looked_at <= most;
}

void gather_blurred(const ScaledScene& scene, const ReceiverView& view, const SourcePlane& plane,
                    std::span<const Vec3> polygon, Horizon horizon, std::span<const std::uint32_t> pieces,
                    Gathered& gathered) {
  start(gathered);
  Gatherer gatherer(scene, view, plane, horizon, gathered);
  const double reach = reach_of(polygon);
  for (const std::uint32_t piece : pieces) {
    ++gathered.looked_at;
    if (const SeenPolygon* seen = gatherer.see(piece)) add_blurred(*seen, reach, gathered);
  }
}

}  // namespace exactff::adaptive
