#include "visibility/walls.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "kernel/vec.h"
#include "scene/planes.h"

namespace exactff::visibility {
namespace {

using kernel::coordinate;

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

}  // namespace exactff::visibility
