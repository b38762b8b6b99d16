#include "visibility/seen_pieces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "kernel/poll.h"
#include "kernel/vec.h"

namespace exactff::visibility {
namespace {

using kernel::PlaneThrough;

constexpr std::size_t kMostHiders = 256;

// What may be hidden: Q of the header.
struct Target {
  std::vector<Vec3> corners;
  Box box;
  bool is_box = false;  // its corners are those of the box
};

// A wall with all of the region on one side of its plane.
class Hider {
 public:
  // `region`: R's corners. `side`: of the plane, on which they lie.
  Hider(const Wall& wall, int side, std::span<const Vec3> region) : wall_(&wall), region_(region), side_(side) {
    for (const Wall::Corners& piece : wall.pieces) size_ += solid_angle(piece);
  }

  [[nodiscard]] double size() const { return size_; }  // an estimate of the solid angle that it fills

  // False if all of the box certainly lies on the region's side of the wall.
  [[nodiscard]] bool may_hide_in(const Box& box) const { return wall_->plane.side_of_box(box.low, box.high) != side_; }

  // A piece that lies in the wall's plane is not hidden, so no box with some of it there is.
  [[nodiscard]] bool hides(const Target& target) {
    if (target.is_box ? wall_->plane.side_of_box(target.box.low, target.box.high) != -side_ : !is_beyond(target)) {
      return false;
    }
    if (lines_.empty()) prepare();
    return is_clear_of_boundary(target) && (wall_->pieces.size() == 1 || crosses_inside(target));
  }

 private:
  // The planes through the region's corners and a line.
  using Fan = std::vector<PlaneThrough>;

  [[nodiscard]] bool is_beyond(const Target& target) const {
    bool off_plane = false;
    for (const Vec3& q : target.corners) {
      const int side = wall_->plane.side_of(q);
      if (side == side_) return false;
      off_plane = off_plane || side != 0;
    }
    return off_plane;
  }

  // Roughly, from the region's first corner.
  [[nodiscard]] double solid_angle(const Wall::Corners& piece) const {
    const Vec3 a = piece[0];
    Vec3 normal, centre;
    const double share = 1.0 / static_cast<double>(piece.size());
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Vec3 p = kernel::difference(piece[i], a);
      const Vec3 n = kernel::cross(p, kernel::difference(piece[(i + 1) % piece.size()], a));
      normal = kernel::sum(normal, n);
      centre = kernel::along(centre, p, share);
    }
    const Vec3 from_a = kernel::difference(region_[0], a), d = kernel::difference(centre, from_a);
    const double square = kernel::dot(d, d);
    return square > 0.0 ? std::abs(kernel::dot(normal, d)) / (square * std::sqrt(square)) : 0.0;
  }

  void prepare() {
    const auto fan = [&](const Vec3& a, const Vec3& b) {
      Fan planes;
      for (const Vec3& r : region_) planes.emplace_back(r, a, b);
      return planes;
    };
    for (const Wall::Line& line : wall_->lines) lines_.push_back(fan(line.a, line.b));
    if (wall_->pieces.size() == 1) return;
    for (const Wall::Corners& piece : wall_->pieces) {
      std::vector<Fan>& edges = edges_.emplace_back();
      for (std::size_t i = 0; i < piece.size(); ++i) edges.push_back(fan(piece[i], piece[(i + 1) % piece.size()]));
    }
  }

  // Where the segment from r to q crosses the plane: 1, 0, -1: on the left of the line, on it, on its right, as seen
  // from the wall's positive side. A line is turned counter-clockwise about an eye on that side.
  [[nodiscard]] int side_of_crossing(const PlaneThrough& through_r, const Vec3& q) const {
    return -side_ * through_r.side_of(q);
  }

  // The side of the line on which all of P lies.
  [[nodiscard]] std::optional<int> side_of_crossings(const Fan& line, const Target& target) const {
    int side = 0;
    const auto agrees = [&](int here) {
      if (here * side < 0) return false;
      if (here != 0) side = here;
      return true;
    };
    for (const PlaneThrough& through_r : line) {
      const int of_box = target.is_box ? through_r.side_of_box(target.box.low, target.box.high) : kernel::kUncertain;
      if (of_box != kernel::kUncertain) {
        if (!agrees(-side_ * of_box)) return std::nullopt;
        continue;
      }
      for (const Vec3& q : target.corners) {
        if (!agrees(side_of_crossing(through_r, q))) return std::nullopt;
      }
    }
    return side;
  }

  [[nodiscard]] bool is_clear_of_boundary(const Target& target) const {
    Wall::Segments clear_of;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      const std::optional<int> side = side_of_crossings(lines_[l], target);
      if (l < wall_->outer_lines && side.value_or(-1) < 0) return false;
      if (side) clear_of |= *side >= 0 ? wall_->lines[l].right : wall_->lines[l].left;
    }
    return clear_of == wall_->boundary;
  }

  // Whether one of the segments crosses the wall inside a piece.
  [[nodiscard]] bool crosses_inside(const Target& target) const {
    for (std::size_t r = 0; r < region_.size(); ++r) {
      for (const Vec3& q : target.corners) {
        const auto crosses = [&](const std::vector<Fan>& edges) {
          return std::ranges::all_of(edges, [&](const Fan& edge) { return side_of_crossing(edge[r], q) > 0; });
        };
        if (std::ranges::any_of(edges_, crosses)) return true;
      }
    }
    return false;
  }

  const Wall* wall_;
  std::span<const Vec3> region_;
  int side_;
  double size_ = 0.0;
  std::vector<Fan> lines_;               // of the wall's lines
  std::vector<std::vector<Fan>> edges_;  // of its pieces, if there are several
};

bool meets(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

class SeeingRegion {
 public:
  SeeingRegion(std::span<const Wall> walls, const Box& region) : corners_(corners_of(region)) {
    for (const Wall& wall : walls) {
      const int side = wall.plane.side_of(corners_[0]);
      const auto is_there = [&](const Vec3& r) { return wall.plane.side_of(r) == side; };
      if (side != 0 && std::ranges::all_of(corners_, is_there)) hiders_.emplace_back(wall, side, corners_);
    }
    std::ranges::stable_sort(hiders_, std::ranges::greater(), &Hider::size);
    if (hiders_.size() > kMostHiders) hiders_.erase(hiders_.begin() + kMostHiders, hiders_.end());
    waiting_.emplace_back();
    for (Hider& hider : hiders_) waiting_[0].push_back(&hider);
  }
  SeeingRegion(const SeeingRegion&) = delete;
  SeeingRegion& operator=(const SeeingRegion&) = delete;

  // A part of the tree at this depth, whose parent was the last one asked for at the depth before.
  [[nodiscard]] bool may_see_into(const Box& box, std::size_t depth) {
    if (waiting_.size() < depth + 2) waiting_.resize(depth + 2);
    target_ = {corners_of(box), box, true};
    waiting_[depth + 1].clear();
    for (Hider* hider : waiting_[depth]) {
      if (!hider->may_hide_in(box)) continue;
      if (hider->hides(target_)) return false;
      waiting_[depth + 1].push_back(hider);
    }
    return true;
  }

  // A piece in the part of the tree last asked for at this depth.
  [[nodiscard]] bool may_see(const Scene& scene, const Piece& piece, std::size_t depth) {
    target_.corners.clear();
    for (const std::uint32_t corner : scene.corners(piece)) target_.corners.push_back(scene.vertices()[corner]);
    target_.is_box = false;
    return std::ranges::none_of(waiting_[depth + 1], [&](Hider* hider) { return hider->hides(target_); });
  }

 private:
  const std::vector<Vec3> corners_;
  std::vector<Hider> hiders_;                 // the largest first
  std::vector<std::vector<Hider*>> waiting_;  // by depth, those that may hide something in its part of the tree
  Target target_;
};

}  // namespace

std::vector<std::uint32_t> pieces_seen_from(const Scene& scene, std::span<const Wall> walls, const Box& region) {
  SeeingRegion from(walls, region);
  std::vector<std::uint32_t> seen;
  kernel::Steps steps("faces", scene.pieces().size());
  shaft_tree(scene).visit_where([&](const Box& box, std::size_t depth) { return from.may_see_into(box, depth); },
                                [&](std::uint32_t piece, std::size_t depth) {
                                  steps.take();
                                  if (from.may_see(scene, scene.pieces()[piece], depth)) seen.push_back(piece);
                                });
  return seen;
}

bool sees_any_of(const Scene& scene, std::span<const Wall> walls, const Box& region,
                 std::span<const std::uint32_t> pieces) {
  const Vec3& first = scene.vertices()[scene.corners(scene.pieces()[pieces.front()]).front()];
  Box target{first, first};
  for (const std::uint32_t piece : pieces) {
    for (const std::uint32_t corner : scene.corners(scene.pieces()[piece])) target.include(scene.vertices()[corner]);
  }
  SeeingRegion from(walls, region);
  bool seen = false;
  shaft_tree(scene).visit_where(
      [&](const Box& box, std::size_t depth) { return !seen && meets(box, target) && from.may_see_into(box, depth); },
      [&](std::uint32_t piece, std::size_t depth) {
        seen = seen || (std::ranges::binary_search(pieces, piece) && from.may_see(scene, scene.pieces()[piece], depth));
      });
  return seen;
}

}  // namespace exactff::visibility
