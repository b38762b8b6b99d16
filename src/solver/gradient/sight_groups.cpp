#include "gradient/sight_groups.h"

#include <cmath>
#include <limits>
#include <utility>

#include "kernel/vec.h"

namespace exactff::gradient {

using visibility::EdgeId;
using visibility::Outlines;

namespace {

// A direction in general position.
constexpr Vec3 kAnywhere{0.5398041762934, 0.2874930211667, 0.7911734960021};

}  // namespace

// The number of the plane with the normal N is |N . c| / |N| for a fixed vector c of about unit length. The components
// of N are known to within e = 2^-49 |a||b| (outlines.h). So its error is below 2 sqrt(3) e / |N| + 8u, for which
// edge.error / |N| + 2^-48 is more than enough.
void SightGroups::add(const Outlines& outlines, EdgeId id) {
  const Outlines::Edge& edge = outlines.edge(id);
  const double length = std::sqrt(kernel::dot(edge.normal, edge.normal));
  const double number = std::abs(kernel::dot(edge.normal, kAnywhere)) / length;
  const double error = edge.error / length + 0x1p-48;
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  if (error < 0x1p-10 && number <= 2.0) {
    entries_.push_back({number - error, number + error, id});
  } else {
    entries_.push_back({-kUnbounded, kUnbounded, id});
  }
}

bool are_on_one_line(const Outlines& outlines, std::span<const EdgeId> group) {
  const auto ends_of = [&](EdgeId id) {
    const Outlines::Edge& edge = outlines.edge(id);
    return std::pair(outlines.vertex(edge.a), outlines.vertex(edge.b));
  };
  const auto ends = ends_of(group.front());
  if (!ends.first || !ends.second) return false;
  const Vec3& origin = outlines.position(*ends.first);
  const kernel::ExactVec3 along = kernel::exact_difference(outlines.position(*ends.second), origin).v;
  return std::ranges::all_of(group, [&](EdgeId id) {
    const auto [a, b] = ends_of(id);
    const auto is_on_line = [&](std::uint32_t v) {
      return v == *ends.first || v == *ends.second ||
             is_zero(cross(along, kernel::exact_difference(outlines.position(v), origin).v));
    };
    return a && b && is_on_line(*a) && is_on_line(*b);
  });
}

}  // namespace exactff::gradient
