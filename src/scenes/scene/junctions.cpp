#include "scene/junctions.h"

#include <optional>
#include <utility>

#include "kernel/exact_vec.h"

namespace exactff {

namespace {

// Between the ends of the edge, on its line.
bool is_inside(std::uint32_t place, const EdgeOfPiece& edge, std::span<const Vec3> vertices) {
  if (place == edge.low || place == edge.high) return false;
  const Vec3 &x = vertices[place], &a = vertices[edge.low], &b = vertices[edge.high];
  const auto within = [](double u, double from, double to) {
    return std::min(from, to) <= u && u <= std::max(from, to);
  };
  return within(x.x, a.x, b.x) && within(x.y, a.y, b.y) && within(x.z, a.z, b.z) && are_straight(a, x, b);
}

}  // namespace

bool are_straight(const Vec3& a, const Vec3& middle, const Vec3& c) {
  return is_zero(cross(kernel::exact_difference(a, middle).v, kernel::exact_difference(c, middle).v));
}

void cut_at_junctions(std::vector<EdgeOfPiece>& edges, std::span<const Vec3> vertices) {
  if (edges.size() > kMostCut) return;
  std::vector<std::uint32_t> ends;
  for (const EdgeOfPiece& edge : edges) ends.insert(ends.end(), {edge.low, edge.high});
  const auto x_of = [&](std::uint32_t place) { return vertices[place].x; };
  std::ranges::sort(ends, {}, [&](std::uint32_t place) { return std::pair(x_of(place), place); });
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const auto end_inside = [&](const EdgeOfPiece& edge) {
    const auto [least, largest] = std::minmax({x_of(edge.low), x_of(edge.high)});
    const auto first = std::ranges::lower_bound(ends, least, {}, x_of);
    const auto last = std::ranges::upper_bound(ends, largest, {}, x_of);
    const auto found = std::find_if(first, last, [&](std::uint32_t end) { return is_inside(end, edge, vertices); });
    return found == last ? std::nullopt : std::optional(*found);
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::optional<std::uint32_t> inside = end_inside(edges[e]);
    if (!inside) continue;
    // Two edges with the direction of the whole. Both are looked at later.
    const auto [low, high, piece, upwards] = edges[e];
    edges.push_back({std::min(low, *inside), std::max(low, *inside), piece, upwards == (low < *inside)});
    edges.push_back({std::min(high, *inside), std::max(high, *inside), piece, upwards == (*inside < high)});
    edges[e] = edges.back();
    edges.pop_back();
    --e;
  }
}

}  // namespace exactff
