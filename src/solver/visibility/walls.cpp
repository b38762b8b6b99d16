#include "visibility/walls.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/panels.h"

namespace exactff::visibility {
namespace {

using kernel::coordinate;
using kernel::PlaneThrough;

constexpr std::size_t kMostLines = 128;  // of a wall; others count piece by piece

struct Edge {
  Vec3 from, to;
};

// The boundary of a wall, line by line.
class BoundaryMaker {
 public:
  // `above`: a point on the positive side.
  BoundaryMaker(Wall& wall, const Vec3& above) : wall_(wall), above_(above) {}

  // False if there are too many lines or segments; then the wall has none.
  bool run(const std::vector<Edge>& edges) {
    for (const Edge& edge : edges) {
      if (!put(edge)) return false;
    }
    for (const Members& members : lines_) add_segments(members);
    if (segments_.size() > Wall::kMostSegments) return false;
    for (std::size_t s = 0; s < segments_.size(); ++s) wall_.boundary.set(s);
    for (Wall::Line& line : wall_.lines) {
      const kernel::PlaneThrough right(above_, line.a, line.b);
      for (std::size_t s = 0; s < segments_.size(); ++s) {
        const int from = right.side_of(segments_[s].from), to = right.side_of(segments_[s].to);
        line.left[s] = from <= 0 && to <= 0;
        line.right[s] = from >= 0 && to >= 0;
      }
    }
    const auto is_outer = [&](const Wall::Line& line) { return line.left == wall_.boundary; };
    const auto inner = std::stable_partition(wall_.lines.begin(), wall_.lines.end(), is_outer);
    wall_.outer_lines = static_cast<std::size_t>(inner - wall_.lines.begin());
    return true;
  }

 private:
  // The edges on a line; the piece of each lies on its left.
  struct Members {
    kernel::PlaneThrough upright;  // through the line
    std::vector<Edge> edges;
  };

  bool put(const Edge& edge) {
    for (Members& line : lines_) {
      if (line.upright.side_of(edge.from) == 0 && line.upright.side_of(edge.to) == 0) {
        line.edges.push_back(edge);
        return true;
      }
    }
    lines_.push_back({{above_, edge.from, edge.to}, {edge}});
    return lines_.size() <= kMostLines;
  }

  // Places on the line, in the order of the coordinate in which it is longest.
  void add_segments(const Members& members) {
    const Edge& first = members.edges.front();
    const Vec3 along = kernel::difference(first.to, first.from);
    int axis = 0;
    for (int i = 1; i < 3; ++i) {
      if (std::abs(coordinate(along, i)) > std::abs(coordinate(along, axis))) axis = i;
    }
    const auto place = [axis](const Vec3& p) { return coordinate(p, axis); };
    // At each place, how many pieces begin and end on either side.
    std::map<double, std::pair<Vec3, std::array<int, 2>>> changes;
    for (const Edge& edge : members.edges) {
      const bool forward = place(edge.to) > place(edge.from);
      const auto& [low, high] = forward ? std::pair(edge.from, edge.to) : std::pair(edge.to, edge.from);
      const std::size_t which = forward ? 0 : 1;
      ++changes.try_emplace(place(low), low, std::array{0, 0}).first->second.second[which];
      --changes.try_emplace(place(high), high, std::array{0, 0}).first->second.second[which];
    }
    std::array<int, 2> count{};
    std::optional<Vec3> begin;
    const std::size_t before = segments_.size();
    for (const auto& [at, change] : changes) {
      count[0] += change.second[0];
      count[1] += change.second[1];
      const bool bounds = (count[0] > 0) != (count[1] > 0);
      if (begin && !bounds) segments_.push_back({*std::exchange(begin, std::nullopt), change.first});
      if (bounds && !begin) begin = change.first;
    }
    if (segments_.size() > before) wall_.lines.push_back({first.from, first.to, {}, {}});
  }

  Wall& wall_;
  const Vec3 above_;
  std::vector<Members> lines_;
  std::vector<Edge> segments_;
};

class WallMaker {
 public:
  explicit WallMaker(const Scene& scene) : scene_(scene) {
    if (scene.vertices().empty()) return;
    Box box{scene.vertices()[0], scene.vertices()[0]};
    for (const Vec3& vertex : scene.vertices()) box.include(vertex);
    corners_ = visibility::corners_of(box);
  }

  std::vector<Wall> run() {
    const Planes& planes = exactff::planes(scene_);
    for (std::uint32_t plane = 0; plane < planes.count(); ++plane) {
      std::vector<std::uint32_t> pieces;
      for (const std::uint32_t piece : planes.pieces_in(PlaneId{plane})) {
        if (!scene_.pieces()[piece].transparent) pieces.push_back(piece);
      }
      if (!pieces.empty() && !add(pieces)) {
        for (const std::uint32_t piece : pieces) static_cast<void>(add({&piece, 1}));
      }
    }
    return std::move(walls_);
  }

 private:
  // False if its boundary has too many parts.
  bool add(std::span<const std::uint32_t> pieces) {
    Wall wall{plane_through(scene_.pieces()[pieces[0]]), {}, {}, 0, {}};
    const Vec3* above = nullptr;
    bool has_below = false;
    for (const Vec3& corner : corners_) {
      const int side = wall.plane.side_of(corner);
      if (side > 0) above = &corner;
      has_below = has_below || side < 0;
    }
    if (above == nullptr || !has_below) return true;
    for (const std::uint32_t piece : pieces) wall.pieces.push_back(corners_of(scene_.pieces()[piece], *above));
    if (!BoundaryMaker(wall, *above).run(edges_of(wall))) return false;
    walls_.push_back(std::move(wall));
    return true;
  }

  [[nodiscard]] Wall::Corners corners_of(const Piece& piece, const Vec3& above) const {
    Wall::Corners corners;
    for (const std::uint32_t corner : scene_.corners(piece)) corners.push_back(scene_.vertices()[corner]);
    if (plane_through(piece).side_of(above) < 0) std::ranges::reverse(corners);
    return corners;
  }

  [[nodiscard]] kernel::PlaneThrough plane_through(const Piece& piece) const {
    const auto vertex = [&](int i) -> const Vec3& { return scene_.vertices()[piece.frame[i]]; };
    return {vertex(0), vertex(1), vertex(2)};
  }

  // Without pairs of edges that run opposite ways between the same two points, of which there are many in meshes.
  static std::vector<Edge> edges_of(const Wall& wall) {
    using Position = std::array<double, 3>;
    const auto place = [](const Vec3& v) { return Position{v.x, v.y, v.z}; };
    std::map<std::pair<Position, Position>, int> excess;  // of edges one way over those the other way
    for (const Wall::Corners& piece : wall.pieces) {
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const Position from = place(piece[i]), to = place(piece[(i + 1) % piece.size()]);
        excess[std::minmax(from, to)] += from < to ? 1 : -1;
      }
    }
    std::vector<Edge> edges;
    const auto point = [](const Position& p) { return Vec3{p[0], p[1], p[2]}; };
    for (const auto& [ends, count] : excess) {
      if (count > 0) edges.push_back({point(ends.first), point(ends.second)});
      if (count < 0) edges.push_back({point(ends.second), point(ends.first)});
    }
    return edges;
  }

  const Scene& scene_;
  std::vector<Vec3> corners_;  // of the scene's box
  std::vector<Wall> walls_;
};

}  // namespace

std::vector<Wall> walls_of(const Scene& scene) { return WallMaker(scene).run(); }

std::vector<Vec3> corners_of(const Box& box) {
  const auto ends = [](double from, double to) { return from < to ? std::vector{from, to} : std::vector{from}; };
  std::vector<Vec3> corners;
  for (const double x : ends(box.low.x, box.high.x)) {
    for (const double y : ends(box.low.y, box.high.y)) {
      for (const double z : ends(box.low.z, box.high.z)) corners.push_back({x, y, z});
    }
  }
  return corners;
}

// --- Seen pieces ---

namespace {

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
