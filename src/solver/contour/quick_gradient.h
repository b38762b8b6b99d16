// The sums of arc_sum.h in double-double arithmetic: tried first. May decline, but a bound that it gives is always
// valid.
//
// Notation: as in quick_contour.h, but corners are points of space, relative to x: a is the end of the edge nearer to
// x, b = a + d the other one. An edge is the image of the line through a and b, and with C = a x d its nearness is g =
// d x C / |C|^2, since g . d = 0 and g . a = C . (a x d) / |C|^2 = 1. Hence
//   n . g = (n x d) . C / |C|^2,   C . (w x g) = -(w . d)   for w in the plane of the edge,
// and 2 I of a piece from p to q (arc_sum.h), with theta positive from a to b, is theta A + (psi(q) - psi(p)) / |C|
// with
//   A = (n x d) . C / |C|^2,   psi(w) = (w . n) (w . d) / w . w.
// Its terms are -C (theta A / |C| + (psi(q) - psi(p)) / |C|^2) for dF/dx and -C theta / |C| for V. They keep their form
// for a piece from b towards a, whose theta and difference are negative. V is a sum of vectors without units; dF/dx is
// proportional to 1 / length.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "contour/quick_contour.h"

namespace exactff::contour {

// A corner at which the line of a direction meets the plane { y : normal . y = offset }, offset > 0. The error is
// infinite if that is declined.
QuickCorner lifted(const QuickCorner& direction, const std::array<kernel::double_double::Bounded, 3>& normal,
                   const kernel::double_double::Bounded& offset);

class QuickGradient {
 public:
  struct Line {
    bool reversed = false;
    Vector a, b, along, cross;
    kernel::double_double::Bounded size;          // |C|
    kernel::double_double::Bounded inverse;       // 1 / |C|
    kernel::double_double::Bounded growth;        // A / |C|
    kernel::double_double::Bounded psi_a, psi_b;  // of the ends
  };

  QuickGradient() = default;
  explicit QuickGradient(const Vec3& normal);

  // Computes the line of each edge; `lines` has the same length as `edges`.
  void make_lines(std::span<const QuickCorner> corners, std::span<const QuickEdge> edges, std::span<Line> lines) const;
  // Adds pieces of lines, as QuickContour does. `exponent`: the corners are distances times 2^exponent.
  void add(std::span<const QuickPiece> pieces, std::span<const Line> lines, int exponent);
  // From now on, all errors are infinite.
  void decline();

  // As QuickContour::value, for each component.
  using Value = QuickContour::Value;
  [[nodiscard]] Value position(int axis) const;
  [[nodiscard]] Value normal(int axis) const;

 private:
  std::array<double, 3> normal_{};  // largest component in [1/2, 1)
  std::array<kernel::double_double::Bounded, 3> position_{}, v_{};
};

}  // namespace exactff::contour
