#include "whole_view/seen_pieces.h"

#include <algorithm>
#include <cmath>

#include "kernel/exact_vec.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/shaft_tree.h"

namespace exactff::whole_view {
namespace {

constexpr std::size_t kMostHiders = 256;

// A piece that may hide others, all of the region lying on one side of its plane.
struct Hider {
  std::vector<Vec3> corners;
  int side = 0;       // of the plane, on which the region lies
  double size = 0.0;  // an estimate of the solid angle that it fills

  // -1, 0, 1; `side` is the region's.
  [[nodiscard]] int side_of(const Vec3& p) const { return kernel::orientation(corners[0], corners[1], corners[2], p); }

  // Whether the segment from r to q meets the piece; q lies beyond its plane or in it. The plane through r and an edge
  // has the piece on the side that is opposite to r's, since r has moved from the last place to the first.
  [[nodiscard]] bool meets(const Vec3& r, const Vec3& q) const {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (kernel::orientation(r, corners[i], corners[(i + 1) % corners.size()], q) == side) return false;
    }
    return true;
  }
};

// Without repetition: a box may be flat.
std::vector<Vec3> box_corners(const Box& box) {
  const auto ends = [](double low, double high) { return low < high ? std::vector{low, high} : std::vector{low}; };
  std::vector<Vec3> corners;
  for (const double x : ends(box.low.x, box.high.x)) {
    for (const double y : ends(box.low.y, box.high.y)) {
      for (const double z : ends(box.low.z, box.high.z)) corners.push_back({x, y, z});
    }
  }
  return corners;
}

Box box_around(std::span<const Vec3> points) {
  Box box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

class SeeingRegion {
 public:
  SeeingRegion(const Scene& scene, const Box& region)
      : scene_(scene), corners_(box_corners(region)), corners_of_scene_(box_corners(box_around(scene.vertices()))) {
    for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) consider(p);
    const auto is_larger = [](const Hider& a, const Hider& b) { return a.size > b.size; };
    std::ranges::stable_sort(hiders_, is_larger);
    if (hiders_.size() > kMostHiders) hiders_.resize(kMostHiders);
  }

  [[nodiscard]] bool may_see(std::uint32_t piece) const {
    const std::vector<Vec3> corners = corners_of(piece);
    return std::ranges::none_of(hiders_, [&](const Hider& hider) { return hides(hider, corners); });
  }

 private:
  [[nodiscard]] std::vector<Vec3> corners_of(std::uint32_t piece) const {
    std::vector<Vec3> corners;
    for (const std::uint32_t corner : scene_.corners(scene_.pieces()[piece])) {
      corners.push_back(scene_.vertices()[corner]);
    }
    return corners;
  }

  // Where nothing lies behind it, a piece hides nothing.
  void consider(std::uint32_t p) {
    const Piece& piece = scene_.pieces()[p];
    if (piece.transparent) return;
    Hider hider{corners_of(p), 0, 0.0};
    for (int i = 0; i < 3; ++i) {  // three corners that are not on one line, in their order
      if (kernel::orientation(hider.corners[0], hider.corners[1], hider.corners[2], corners_[0]) != 0) break;
      std::rotate(hider.corners.begin(), hider.corners.begin() + 1, hider.corners.end());
    }
    hider.side = hider.side_of(corners_[0]);
    if (hider.side == 0) return;
    if (!std::ranges::all_of(corners_, [&](const Vec3& r) { return hider.side_of(r) == hider.side; })) return;
    const auto is_behind = [&](const Vec3& corner) { return hider.side_of(corner) == -hider.side; };
    if (std::ranges::none_of(corners_of_scene_, is_behind)) return;
    hider.size = solid_angle(hider);
    hiders_.push_back(std::move(hider));
  }

  // Roughly, from the region's first corner.
  [[nodiscard]] double solid_angle(const Hider& hider) const {
    const Vec3 a = hider.corners[0];
    Vec3 normal, centre;
    const double share = 1.0 / static_cast<double>(hider.corners.size());
    for (std::size_t i = 0; i < hider.corners.size(); ++i) {
      const Vec3 p = kernel::difference(hider.corners[i], a);
      const Vec3 n = kernel::cross(p, kernel::difference(hider.corners[(i + 1) % hider.corners.size()], a));
      normal = {normal.x + n.x, normal.y + n.y, normal.z + n.z};
      centre = {centre.x + share * p.x, centre.y + share * p.y, centre.z + share * p.z};
    }
    const Vec3 from_a = kernel::difference(corners_[0], a), d = kernel::difference(centre, from_a);
    const double square = kernel::dot(d, d);
    return square > 0.0 ? std::abs(kernel::dot(normal, d)) / (square * std::sqrt(square)) : 0.0;
  }

  [[nodiscard]] bool hides(const Hider& hider, const std::vector<Vec3>& corners) const {
    bool is_beyond = false;
    for (const Vec3& q : corners) {
      const int side = hider.side_of(q);
      if (side == hider.side) return false;
      is_beyond = is_beyond || side != 0;
    }
    return is_beyond && std::ranges::all_of(corners, [&](const Vec3& q) {
             return std::ranges::all_of(corners_, [&](const Vec3& r) { return hider.meets(r, q); });
           });
  }

  const Scene& scene_;
  const std::vector<Vec3> corners_, corners_of_scene_;  // of boxes
  std::vector<Hider> hiders_;                           // the largest first
};

}  // namespace

std::vector<std::uint32_t> pieces_seen_from(const Scene& scene, const Box& region) {
  const SeeingRegion from(scene, region);
  std::vector<std::uint32_t> seen;
  kernel::Steps steps("faces", scene.pieces().size());
  shaft_tree(scene).query(region.low, {}, [&](std::uint32_t piece) {
    steps.take();
    if (from.may_see(piece)) seen.push_back(piece);
    return true;
  });
  return seen;
}

}  // namespace exactff::whole_view
