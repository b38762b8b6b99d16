#include "view_factors/pair_shaft.h"

#include <algorithm>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

constexpr double kShaftMargin = 0x1p-44;

}  // namespace

// Sides of the hull in two axes that are no sides of a box join corresponding corners of the two.
PairShaft::PairShaft(const Box& a, const Box& b) {
  using kernel::coordinate;
  for (int u = 0; u < 3; ++u) {
    const int v = (u + 1) % 3;
    for (const bool low_u : {true, false}) {
      for (const bool low_v : {true, false}) {
        const auto corner = [&](const Box& box) {
          return std::array{coordinate(low_u ? box.low : box.high, u), coordinate(low_v ? box.low : box.high, v)};
        };
        const std::array<double, 2> p = corner(a), q = corner(b);
        for (const double sign : {1.0, -1.0}) {
          HalfSpace side{u, v, {sign * (q[1] - p[1]), -sign * (q[0] - p[0])}, p, 0.0};
          side.limit = std::max(extreme(side, a, 1), extreme(side, b, 1)) + kShaftMargin;
          if (side.limit <= 2.0 * kShaftMargin && side.normal != std::array{0.0, 0.0}) half_spaces_.push_back(side);
        }
      }
    }
  }
}

double PairShaft::extreme(const HalfSpace& half_space, const Box& box, int sign) {
  const auto along = [&](int axis, std::size_t i) {
    const double low = half_space.normal[i] * (kernel::coordinate(box.low, axis) - half_space.origin[i]);
    const double high = half_space.normal[i] * (kernel::coordinate(box.high, axis) - half_space.origin[i]);
    return sign > 0 ? std::max(low, high) : std::min(low, high);
  };
  return along(half_space.first, 0) + along(half_space.second, 1);
}

bool PairShaft::is_outside(const Box& box) const {
  return std::ranges::any_of(half_spaces_,
                             [&](const HalfSpace& side) { return extreme(side, box, -1) > side.limit + kShaftMargin; });
}

}  // namespace exactff::view_factors
