#include "visibility/convex_clip.h"

#include <algorithm>

namespace exactff::visibility {

using kernel::Direction;
using kernel::Integer;
using kernel::Ring;

namespace {

// The direction in which the segment from a (at signed distance da) to b (at db, of the other sign) meets the
// plane: a |db| + b |da|.
Direction crossing(const Direction& a, const Integer& da, const Direction& b, const Integer& db) {
  return kernel::make_direction(a.exact * abs(db) + b.exact * abs(da));
}

std::vector<int> sides_of(const Ring& ring, const Direction& normal) {
  std::vector<int> signs(ring.size());
  std::transform(ring.begin(), ring.end(), signs.begin(), [&](const Direction& t) { return side(normal, t); });
  return signs;
}

}  // namespace

ClipResult clip(Ring& ring, const Direction& normal) {
  const std::vector<int> signs = sides_of(ring, normal);
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
      kept.push_back(
          crossing(ring[i], dot(normal.exact, ring[i].exact), ring[next], dot(normal.exact, ring[next].exact)));
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
