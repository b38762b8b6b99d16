#include "adaptive/source_roots.h"

#include <algorithm>
#include <set>
#include <unordered_map>

#include "adaptive/plane_side.h"
#include "scene/planes.h"

namespace exactff::adaptive {

namespace {

class RootMaker {
 public:
  RootMaker(const Scene& scene, const std::vector<Vec3>& points) : scene_(scene), points_(points) {}

  void add_face(FaceId face) {
    const std::uint32_t first = scene_.face(face).first_piece;
    const std::uint32_t count = scene_.face(face).piece_count;
    for (std::uint32_t piece = first; piece < first + count; ++piece) {
      if (is_new(piece)) add_piece(piece);
    }
  }

  SourceRoots take() { return std::move(result_); }

 private:
  using Key = std::vector<std::array<double, 3>>;

  // The corners in order, starting at the least one.
  bool is_new(std::uint32_t piece) {
    Key key;
    for (const std::uint32_t v : scene_.corners(scene_.pieces()[piece])) {
      const Vec3& p = scene_.vertices()[v];
      key.push_back({p.x, p.y, p.z});
    }
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    return seen_.insert(std::move(key)).second;
  }

  void add_piece(std::uint32_t index) {
    const Piece& piece = scene_.pieces()[index];
    const std::span<const std::uint32_t> corners = scene_.corners(piece);
    const std::uint32_t plane = plane_of(index);
    if (corners.size() <= 4) {
      add_root(corners, plane, index);
      return;
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      add_root(std::array{corners[0], corners[i], corners[i + 1]}, plane, index);
    }
  }

  void add_root(std::span<const std::uint32_t> corners, std::uint32_t plane, std::uint32_t piece) {
    SourceRoot root{{}, static_cast<int>(corners.size()), plane, piece};
    std::transform(corners.begin(), corners.end(), root.corners.begin(), [&](std::uint32_t v) { return points_[v]; });
    result_.roots.push_back(root);
  }

  std::uint32_t plane_of(std::uint32_t index) {
    const auto found = plane_of_piece_.find(index);
    if (found != plane_of_piece_.end() && same_front(index, result_.planes[found->second])) return found->second;
    const auto plane = static_cast<std::uint32_t>(result_.planes.size());
    result_.planes.push_back(make_plane(index));
    for (const std::uint32_t piece : result_.planes.back().coplanar) plane_of_piece_[piece] = plane;
    return plane;
  }

  SourcePlane make_plane(std::uint32_t index) const {
    SourcePlane plane;
    const Piece& piece = scene_.pieces()[index];
    for (std::size_t i = 0; i < 3; ++i) {
      plane.frame[i] = points_[piece.frame[i]];
      plane.exact_frame[i] = scene_.vertices()[piece.frame[i]];
    }
    const Planes& all = planes(scene_);
    const auto coplanar = all.pieces_in(all.of_piece(index));
    plane.coplanar.assign(coplanar.begin(), coplanar.end());
    return plane;
  }

  // Two faces in one plane may face opposite sides.
  bool same_front(std::uint32_t index, const SourcePlane& plane) const {
    const std::uint32_t* f = scene_.pieces()[index].frame;
    const Vec3 normal = plane_normal(points_[f[0]], points_[f[1]], points_[f[2]]).value;
    return dot(normal, plane_normal(plane.frame[0], plane.frame[1], plane.frame[2]).value) > 0.0;
  }

  const Scene& scene_;
  const std::vector<Vec3>& points_;
  SourceRoots result_;
  std::set<Key> seen_;
  std::unordered_map<std::uint32_t, std::uint32_t> plane_of_piece_;
};

}  // namespace

SourceRoots make_source_roots(const Scene& scene, const std::vector<Vec3>& points, const Selection& selection) {
  RootMaker maker(scene, points);
  for (const FaceId face : scene.faces_of(selection)) maker.add_face(face);
  return maker.take();
}

}  // namespace exactff::adaptive
