// The form factor from the origin to axis-aligned rectangles, by the catalogue's closed form: the truth that stiff
// scenes are judged by. It knows nothing of visibility, of clipping or of Eq. (4).
//
// For a rectangle [u1,u2] x [v1,v2] in the plane w = +-h, h > 0, Lambert's vector is
//   L_u = D Hu,  L_v = D Hv,  L_w = +-D G,    D f = f(u2,v2) - f(u1,v2) - f(u2,v1) + f(u1,v1),
//   Hu(u,v) = -h/(2 pi A) atan(v/A),  Hv(u,v) = -h/(2 pi B) atan(u/B),
//   G(u,v) = (u/A atan(v/A) + v/B atan(u/B)) / (2 pi),    A = sqrt(u^2 + h^2), B = sqrt(v^2 + h^2),
// and F = n . L / |n| wherever the rectangle lies above the horizon. Hu and Hv are the factor of a perpendicular, G
// that of a parallel rectangle (J. R. Howell's catalogue, B-4 and B-3).
#pragma once

#include <array>
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
[[nodiscard]] bool is_empty(const Interval& a);  // or a single number

// Perpendicular to `axis` (0, 1, 2: x, y, z) at the signed distance from the origin; u and v are the next axes in
// cyclic order. Empty where an interval is.
struct Rectangle {
  int axis = 2;
  Rational distance;  // not zero
  Interval u, v;
};

// A signed sum of rectangles, every one above the horizon of the normal.
class ClosedForm {
 public:
  explicit ClosedForm(const Vec3& normal);

  void add(const Rectangle& rectangle, const Rational& weight = 1);

  // Encloses the sum; a relative radius of at most 2^-120, or the ball at 2^17 bits. Exactly zero without rectangles.
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

}  // namespace exactff::stress
