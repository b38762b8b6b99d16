// Two ways to compute the form factors of stiff scenes. The true value: the form factor from the origin to axis-aligned
// rectangles, by the closed form of Howell's catalogue, independent of visibility, clipping and Eq. (4). And what
// programs do: Eq. (4) in plain double.
//
// For a rectangle [u1,u2] x [v1,v2] in the plane w = +-h, h > 0, Lambert's vector is
//   L_u = D Hu,  L_v = D Hv,  L_w = +-D G,    D f = f(u2,v2) - f(u1,v2) - f(u2,v1) + f(u1,v1),
//   Hu(u,v) = -h/(2 pi A) atan(v/A),  Hv(u,v) = -h/(2 pi B) atan(u/B),
//   G(u,v) = (u/A atan(v/A) + v/B atan(u/B)) / (2 pi),    A = sqrt(u^2 + h^2), B = sqrt(v^2 + h^2),
// and F = n . L / |n| if the rectangle lies above the horizon. Hu and Hv are the factor of a perpendicular rectangle, G
// that of a parallel one (J. R. Howell's catalogue, B-4 and B-3).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/geometry.h"
#include "kernel/ball.h"
#include "kernel/numbers.h"

namespace exactff::stress {

using kernel::Rational;

struct Interval {
  Rational low, high;
};
[[nodiscard]] Interval intersection(const Interval& a, const Interval& b);
[[nodiscard]] bool is_empty(const Interval& a);  // also if it is a single number

// A rectangle perpendicular to `axis` (0, 1, 2: x, y, z) at the signed distance from the origin; u and v are the next
// axes in cyclic order. Empty if one of the intervals is.
struct Rectangle {
  int axis = 2;
  Rational distance;  // not zero
  Interval u, v;
};

// A signed sum of rectangles, all of which must be above the horizon of the normal.
class ClosedForm {
 public:
  explicit ClosedForm(const Vec3& normal);

  void add(const Rectangle& rectangle, const Rational& weight = 1);

  // Encloses the sum with a relative radius of at most 2^-120, or returns the ball at 2^17 bits. Exactly zero if there
  // are no rectangles.
  [[nodiscard]] Enclosure value() const;

 private:
  struct Term {
    Rectangle rectangle;
    Rational weight;
  };
  [[nodiscard]] Ball evaluate(long bits) const;

  std::array<Rational, 3> normal_;
  std::vector<Term> terms_;
};

// --- Eq. (4) in double ---
//
// Eq. (4) of F. Tampieri (1992) in plain double, in the three forms that programs use: the results of careful and of
// careless code. Each estimates the form factor of a region from its boundary.

enum class AngleFormula {
  kAcos,             // unit vectors a and b, acos(a . b), a x b
  kAtan2,            // atan2(|a x b|, a . b)
  kAtan2Difference,  // the same, but a x b is computed as a x (b - a)
};

// A closed polygon, counter-clockwise seen from the front of the source; holes are clockwise.
using Polygon = std::vector<Vec3>;

// -1/(2 pi |n|) times the sum over the edges of angle n . (a x b) / |a x b|, with a and b relative to x. Nothing is
// clamped, but the angle of two unit vectors is 0 or pi if their product rounds beyond 1. An edge with a x b = 0 adds
// nothing.
[[nodiscard]] double form_factor_in_double(std::span<const Polygon> region, const Vec3& x, const Vec3& normal,
                                           AngleFormula formula);

}  // namespace exactff::stress
