#include "visibility/convex_clip.h"

#include <algorithm>
#include <utility>

#include "kernel/expect.h"

namespace exactff::visibility {

using kernel::Direction;
using kernel::ExactVec3;
using kernel::Integer;
using kernel::Ring;

// Repeated clips construct corners from constructed corners: without the division the numbers would grow with each
// clip.
Direction crossing(const ExactVec3& a, const Integer& da, const ExactVec3& b, const Integer& db) {
  ExactVec3 direction = a * abs(db) + b * abs(da);
  make_primitive(direction);
  return kernel::make_direction(std::move(direction));
}

ClipResult clip(Ring& ring, const Direction& normal) {
  std::vector<int> signs(ring.size());
  std::transform(ring.begin(), ring.end(), signs.begin(), [&](const Direction& t) { return side(normal, t); });
  if (std::none_of(signs.begin(), signs.end(), [](int s) { return s > 0; })) {
    ring.clear();
    return ClipResult::kEmpty;
  }
  if (std::none_of(signs.begin(), signs.end(), [](int s) { return s < 0; })) return ClipResult::kInside;

  Ring kept;
  kept.reserve(ring.size() + 1);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t next = (i + 1) % ring.size();
    if (signs[i] >= 0) kept.push_back(ring[i]);
    if (signs[i] * signs[next] < 0) {
      const ExactVec3& a = ring[i].exact;
      const ExactVec3& b = ring[next].exact;
      kept.push_back(crossing(a, dot(normal.exact, a), b, dot(normal.exact, b)));
    }
  }
  ring = std::move(kept);
  return ClipResult::kCut;
}

void drop_collinear_corners(Ring& ring) {
  Ring kept;
  kept.reserve(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Direction& before = kept.empty() ? ring.back() : kept.back();
    if (orientation(before, ring[i], ring[(i + 1) % ring.size()]) != 0) kept.push_back(ring[i]);
  }
  EXACTFF_EXPECT(kept.size() >= 3);
  ring = std::move(kept);
}

std::vector<Direction> side_planes(const Ring& ring) {
  std::vector<Direction> planes;
  planes.reserve(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i) {
    planes.push_back(kernel::make_direction(cross(ring[(i + 1) % ring.size()].exact, ring[i].exact)));
  }
  return planes;
}

}  // namespace exactff::visibility
