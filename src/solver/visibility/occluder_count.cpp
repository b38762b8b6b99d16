#include "visibility/occluder_count.h"

#include <array>
#include <cmath>

#include "scene/shaft_tree.h"

namespace exactff::visibility {

using Edge = Outlines::Edge;
using kernel::Approx3;

Approx3 between(const Outlines::Corner& a, const Outlines::Corner& b, double t) {
  const double l = 1.0 - t;
  return {l * a.t.x + t * b.t.x, l * a.t.y + t * b.t.y, l * a.t.z + t * b.t.z};
}

// Two directions about orthogonal to d and to each other, with components of at most 1.
void find_axes(const Approx3& d, Approx3& u, Approx3& v) {
  const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
  u = x <= y && x <= z ? Approx3{0.0, -d.z, d.y} : y <= z ? Approx3{d.z, 0.0, -d.x} : Approx3{-d.y, d.x, 0.0};
  const auto normalise = [](Approx3& a) {
    const double size = kernel::max_norm(a);
    a = {a.x / size, a.y / size, a.z / size};
  };
  normalise(u);
  v = {d.y * u.z - d.z * u.y, d.z * u.x - d.x * u.z, d.x * u.y - d.y * u.x};
  normalise(v);
}

std::optional<OccluderCount::Counts> OccluderCount::beside(EdgeId id, double t) {
  const Edge edge = outlines_.edge(id);
  const Outlines::Corner &a = outlines_.corner(edge.a), &b = outlines_.corner(edge.b);
  const Approx3 d = between(a, b, t);
  const double size = kernel::max_norm(d);
  if (!(a.size == a.size && b.size == b.size && size > 0.0)) return std::nullopt;
  // The point lies within 2^-49 (|a| + |b|) of d. For a vector u with components of at most 1, u . p is below `error`
  // |p|, and u less (u . p) p / |p|^2 is a normal that is orthogonal to p.
  Approx3 u, v;
  find_axes(d, u, v);
  const double error = 0x1p-45 * (a.size + b.size) / size;
  const Vec3 n{u.x, u.y, u.z}, m{v.x, v.y, v.z};
  const auto turned = [](const Vec3& w) { return Vec3{-w.x, -w.y, -w.z}; };
  const std::array<HalfSpace, 6> around{{{n, 0.0, error},
                                         {turned(n), 0.0, error},
                                         {m, 0.0, error},
                                         {turned(m), 0.0, error},
                                         silhouettes_.front(),
                                         silhouettes_.toward()}};
  const HalfSpaceGroups ray(around);
  Counts counts;
  bool clear = true;
  const std::size_t edges = outlines_.edges().size();
  shaft_tree(query_.view.scene).query_with_inside(query_.view.x, ray, [&](std::uint32_t piece, bool /*inside*/) {
    const int facing = silhouettes_.facing(piece);
    if (facing == 0) return true;
    const std::optional<int> side = sides_of(piece, facing, id, t);
    clear = side.has_value() && outlines_.edges().size() == edges;
    if (!clear) return false;
    counts.left += (*side & 1) != 0 ? 1 : 0;
    counts.right += (*side & 2) != 0 ? 1 : 0;
    return true;
  });
  return clear ? std::optional(counts) : std::nullopt;
}

// What the piece covers beside the point: 1 on its left, 2 on its right. Nullopt if doubles do not tell.
std::optional<int> OccluderCount::sides_of(std::uint32_t piece, int facing, EdgeId id, double t) {
  const Edge edge = outlines_.edge(id);
  const auto corners = silhouettes_.corners_of(piece);
  const double l = 1.0 - t;
  int covered = 3;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const CornerId from = corners[c], to = corners[c + 1 == corners.size() ? 0 : c + 1];
    const Edge line = outlines_.line_through(from, to);
    const Height a = outlines_.height(line, edge.a), b = outlines_.height(line, edge.b);
    const double first = l * a.value, second = t * b.value, height = first + second;
    const double error = l * a.error + t * b.error + 0x1p-50 * (std::abs(first) + std::abs(second));
    int side = height > error ? 1 : height < -error ? -1 : 0;
    if (side == 0) {
      const int side_a = outlines_.side(line, edge.a), side_b = outlines_.side(line, edge.b);
      if (side_a * side_b < 0) return std::nullopt;
      side = side_a != 0 ? side_a : side_b;
    }
    if (side * facing > 0) return 0;
    if (side != 0) continue;
    // The piece's side lies along the edge: the piece is where its other corners are.
    int other = 0;
    for (std::size_t k = 0; k < corners.size() && other == 0; ++k) other = outlines_.side(edge, corners[k]);
    covered &= other > 0 ? 1 : 2;
  }
  return covered;
}

}  // namespace exactff::visibility
