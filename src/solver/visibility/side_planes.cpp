#include "visibility/side_planes.h"

#include "kernel/lanes.h"

namespace exactff::visibility {

using namespace kernel::lanes;

EXACTFF_CLONES Sides sides_of(std::span<const SidePlane> planes, const FourCorners& corners) {
  constexpr unsigned kAll = 15;
  const auto& [a, b, c, d] = corners;
  const Four x{a->t.x, b->t.x, c->t.x, d->t.x}, y{a->t.y, b->t.y, c->t.y, d->t.y}, z{a->t.z, b->t.z, c->t.z, d->t.z},
      size{a->size, b->size, c->size, d->size};
  Sides sides{true, true, true, false, 0};
  bool is_first = true;
  Outlines::LineBits bit = 1;  // 0 after the 32nd plane
  for (const SidePlane& plane : planes) {
    const Four height = plane.normal.x * x + plane.normal.y * y + plane.normal.z * z - plane.offset;
    const Four error = plane.error_per_size * size + plane.error;
    const unsigned above = lane_bits(height > error), below = lane_bits(-height > error);
    if (below == kAll) return {true, false, false, is_first, 0, true};  // one plane is enough, whatever the others say
    sides.certain = sides.certain && (above | below) == kAll;
    sides.some_above_each = sides.some_above_each && above != 0;
    sides.all_above_each = sides.all_above_each && above == kAll;
    if (is_first) sides.some_below_first = below != 0;
    if (above == kAll) sides.wholly_above |= bit;
    is_first = false;
    bit <<= 1U;
  }
  return sides;
}

}  // namespace exactff::visibility
