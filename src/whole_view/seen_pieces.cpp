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

class SeeingRegion {
 public:
  SeeingRegion(const Scene& scene, std::span<const Vec3> corners) : scene_(scene), corners_(corners) {
    for (const Vec3& v : scene.vertices()) include(v);
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
  void include(const Vec3& v) {
    low_ = {std::min(low_.x, v.x), std::min(low_.y, v.y), std::min(low_.z, v.z)};
    high_ = {std::max(high_.x, v.x), std::max(high_.y, v.y), std::max(high_.z, v.z)};
  }

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
    bool has_something_behind = false;
    for (const double x : {low_.x, high_.x}) {
      for (const double y : {low_.y, high_.y}) {
        for (const double z : {low_.z, high_.z}) {
          has_something_behind = has_something_behind || hider.side_of({x, y, z}) == -hider.side;
        }
      }
    }
    if (!has_something_behind) return;
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
  std::span<const Vec3> corners_;
  Vec3 low_{INFINITY, INFINITY, INFINITY}, high_{-INFINITY, -INFINITY, -INFINITY};
  std::vector<Hider> hiders_;  // the largest first
};

}  // namespace

std::vector<std::uint32_t> pieces_seen_from(const Scene& scene, std::span<const Vec3> corners) {
  const SeeingRegion region(scene, corners);
  std::vector<std::uint32_t> seen;
  kernel::Steps steps("faces", scene.pieces().size());
  shaft_tree(scene).query(corners[0], {}, [&](std::uint32_t piece) {
    steps.take();
    if (region.may_see(piece)) seen.push_back(piece);
    return true;
  });
  return seen;
}

}  // namespace exactff::whole_view
