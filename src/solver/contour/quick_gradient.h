// The sums of arc_sum.h in double-double arithmetic: tried first. May decline, but a bound that it gives is always
// valid.
//
// Notation: as in quick_contour.h, but corners are points of space, relative to x: a is the end of the edge nearer to
// x, b = a + d the other one. An edge is the image of the line through a and b, and with C = a x d its nearness is g =
// d x C / |C|^2, since g . d = 0 and g . a = C . (a x d) / |C|^2 = 1. Hence
//   n . g = (n x d) . C / |C|^2,   C . (w x g) = -(w . d)   for w in the plane of the edge,
// and 2 I of a piece from p to q (arc_sum.h), with theta positive from a to b, is
// theta A + (psi(q) - psi(p)) / |C| with
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

// x 2^exponent; declined where that is not certain to be exact.
[[nodiscard]] kernel::double_double::Bounded times_power(const kernel::double_double::Bounded& x, int exponent);

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

  // What a piece adds to the derivatives by the points a and b of its line is cross times these, over 2 pi |n| and
  // times 2^exponent. They are the sums of arc_sum.h for the shares g_a = b x C / |C|^2 and g_b = C x a / |C|^2 of the
  // points (gradient/vertex_motion.h), which add up to g:
  //   a: theta (n x b) . C / |C|^3 + (psi(q) - psi(p)) / |C|^2 with psi(w) = (w . n) (w . b) / w . w,
  //   b: the same with a for b, negated.
  struct Shares {
    kernel::double_double::Bounded a, b;
  };
  void find_shares(std::span<const QuickPiece> pieces, std::span<const Line> lines, std::span<Shares> shares) const;

  // As QuickContour::value, for each component.
  using Value = QuickContour::Value;
  [[nodiscard]] Value position(int axis) const;
  [[nodiscard]] Value normal(int axis) const;
  // F = n . V / |n|.
  [[nodiscard]] Value form_factor() const;
  // A sum of such parts, over 2 pi |n|.
  [[nodiscard]] Value over_turn_and_length(const kernel::double_double::Bounded& sum) const;

 private:
  std::array<double, 3> normal_{};  // largest component in [1/2, 1)
  std::array<kernel::double_double::Bounded, 3> position_{}, v_{};
};

}  // namespace exactff::contour
