#include "division/edge_cuts.h"

#include <algorithm>
#include <tuple>

#include "kernel/vec.h"
#include "scene/junctions.h"
#include "scene/places.h"

namespace exactff::division {

EdgeCuts::EdgeCuts(const Scene& scene, CutPoints& points) : scene_(scene), points_(points) {
  const std::span<const std::uint32_t> place = places(scene);
  std::vector<Ends> edges;
  for (const Piece& piece : scene.pieces()) {
    const std::span<const std::uint32_t> corners = scene.corners(piece);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const std::uint32_t a = place[corners[c]], b = place[corners[(c + 1) % corners.size()]];
      corners_[0].push_back(a);
      edges.push_back(std::minmax(a, b));
    }
  }
  corners_[1] = corners_[2] = corners_[0];
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::uint32_t>& sorted = corners_[axis];
    std::ranges::sort(sorted, {}, [&](std::uint32_t v) { return std::pair(kernel::coordinate(points[v], axis), v); });
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const Ends& ends : edges) of_edges_.emplace(ends, cut(ends));
}

// In the order from the first end. Of the corners within the range of one coordinate, the axis with the fewest.
std::vector<std::uint32_t> EdgeCuts::junctions(const Ends& ends) const {
  const Vec3 a = points_[ends.first], b = points_[ends.second];
  std::span<const std::uint32_t> fewest = corners_[0];
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](std::uint32_t v) { return kernel::coordinate(points_[v], axis); };
    const auto [low, high] = std::minmax({kernel::coordinate(a, axis), kernel::coordinate(b, axis)});
    const auto first = std::ranges::lower_bound(corners_[axis], low, {}, at);
    const auto last = std::ranges::upper_bound(corners_[axis], high, {}, at);
    if (static_cast<std::size_t>(last - first) < fewest.size()) fewest = {first, last};
  }
  const auto within = [](double u, double from, double to) {
    return std::min(from, to) <= u && u <= std::max(from, to);
  };
  std::vector<std::uint32_t> found;
  for (const std::uint32_t v : fewest) {
    const Vec3 x = points_[v];
    if (v == ends.first || v == ends.second || !within(x.x, a.x, b.x) || !within(x.y, a.y, b.y) ||
        !within(x.z, a.z, b.z)) {
      continue;
    }
    if (are_straight(a, x, b)) found.push_back(v);
  }
  const auto from_a = [&](std::uint32_t v) {
    const Vec3 x = points_[v];
    return std::tuple(a.x < b.x ? x.x : -x.x, a.y < b.y ? x.y : -x.y, a.z < b.z ? x.z : -x.z);
  };
  std::ranges::sort(found, {}, from_a);
  return found;
}

std::span<const std::uint32_t> EdgeCuts::part(std::uint32_t from, std::uint32_t to) {
  const Ends ends = std::minmax(from, to);
  const auto [place, is_new] = of_parts_.try_emplace(ends);
  if (is_new) place->second = points_.between(ends.first, ends.second);
  return place->second;
}

std::vector<std::uint32_t> EdgeCuts::cut(const Ends& ends) {
  if (points_.parts(ends.first, ends.second) == 1) return {};
  std::vector<std::uint32_t> stops = junctions(ends), all;
  stops.push_back(ends.second);
  std::uint32_t from = ends.first;
  for (const std::uint32_t to : stops) {
    const std::span<const std::uint32_t> points = part(from, to);
    if (from < to) {
      all.insert(all.end(), points.begin(), points.end());
    } else {
      all.insert(all.end(), points.rbegin(), points.rend());
    }
    if (to != ends.second) all.push_back(to);
    from = to;
  }
  return all;
}

std::vector<std::uint32_t> EdgeCuts::outline(const Piece& piece) const {
  const std::span<const std::uint32_t> place = places(scene_), corners = scene_.corners(piece);
  std::vector<std::uint32_t> all;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::uint32_t a = place[corners[c]], b = place[corners[(c + 1) % corners.size()]];
    all.push_back(a);
    const std::vector<std::uint32_t>& points = of_edges_.at(std::minmax(a, b));
    if (a < b) {
      all.insert(all.end(), points.begin(), points.end());
    } else {
      all.insert(all.end(), points.rbegin(), points.rend());
    }
  }
  return all;
}

}  // namespace exactff::division
