// Exact directions from the receiving point, each with its floating-point approximation.
//
// A direction stands for the ray x + t v, t > 0; a positive factor does not change it. A plane through x is given by
// its normal, which is also a Direction.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "kernel/filter.h"

namespace exactff::kernel {

struct Direction {
  ExactVec3 exact;
  Approx3 approx;
};

inline Direction make_direction(ExactVec3 exact) {
  const Approx3 rounded = approx(exact);
  return {std::move(exact), rounded};
}

// Sign of normal . t: by the filter if it is certain, else by the exact product.
inline int side(const Direction& normal, const Direction& t) {
  const int filtered = sign_of_dot(normal.approx, t.approx);
  return filtered != kUncertain ? filtered : sign(dot(normal.exact, t.exact));
}

// Sign of det(a, b, c).
inline int orientation(const Direction& a, const Direction& b, const Direction& c) {
  return sign(dot(cross(a.exact, b.exact), c.exact));
}

// A convex polygon seen from x. Unless stated otherwise its corners are counter-clockwise as seen from x, that is,
// det(a, b, c) < 0 for three corners in order.
using Ring = std::vector<Direction>;

// A direction from x in double-double form, for code that only stores it. Every true component is within `error` of
// hi + lo (0: exact).
struct FineDirection {
  std::array<double, 3> hi{};
  std::array<double, 3> lo{};
  double error = 0.0;
};

}  // namespace exactff::kernel
