#include "visibility/side_planes.h"

#include "kernel/lanes.h"

namespace exactff::visibility {

using namespace kernel::lanes;

EXACTFF_CLONES Sides sides_of(std::span<const SidePlane> planes, const FourCorners& corners) {
  constexpr unsigned kAll = 15;
  const Four x = load(corners.x.data()), y = load(corners.y.data()), z = load(corners.z.data()),
             size = load(corners.size.data());
  Sides sides{true, true, true, false};
  bool is_first = true;
  for (const SidePlane& plane : planes) {
    const Four height = plane.normal.x * x + plane.normal.y * y + plane.normal.z * z - plane.offset;
    const Four error = plane.error_per_size * size + plane.error;
    const unsigned above = lane_bits(height > error), below = lane_bits(-height > error);
    if (below == kAll) return {true, false, false, is_first};  // one plane is enough, whatever the others say
    sides.certain = sides.certain && (above | below) == kAll;
    sides.some_above_each = sides.some_above_each && above != 0;
    sides.all_above_each = sides.all_above_each && above == kAll;
    if (is_first) sides.some_below_first = below != 0;
    is_first = false;
  }
  return sides;
}

}  // namespace exactff::visibility
