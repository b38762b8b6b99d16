// Tampieri's Eq. (4) in double-double arithmetic: the first attempt at what contour.h does in ball arithmetic, more
// than ten times as fast. It may decline, never lie. The error of a whole edge is about 2^-100 of the angle it is seen
// under, whatever that is, and in proportion to the edge that of a crossing; hence F is rounded correctly unless its
// terms cancel by some 45 bits.
//
// Notation: as in contour.h, with a piece of the edge from a to b given by corners alone, of which a is the nearer to
// x, and d = b - a. Where the plane through x and another edge, with the normal N, meets the edge, it has the direction
//   s a + m d,  s : m = |N . d| : |N . a|,
// which is l a + m b with l = s - m. Hence w = s_p m_q - m_p s_q of the piece from p to q.
//
// Corners whose largest component is outside [2^-200, 2^200] are declined, so that no operation overflows and whatever
// underflows is covered by kUnderflow (double_double.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "contour/quick_vector.h"
#include "exactff/geometry.h"
#include "kernel/double_double.h"
#include "kernel/exact_vec.h"
#include "kernel/fine_direction.h"

namespace exactff::contour {

using QuickCorner = kernel::FineDirection;

// (vertex - x) * 2^scale_exponent, exactly but for underflow; NaN where it overflows.
QuickCorner quick_corner(const Vec3& vertex, const Vec3& x, int scale_exponent);
// The direction with its largest component scaled into [1/2, 1). Requires that it is not zero.
QuickCorner quick_corner(const kernel::ExactVec3& direction);

// An edge from the corner a to the corner b, by their numbers.
struct QuickEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

// An edge with what all pieces of it and all that its line crosses have in common. Where it is declined, the error of
// the last three is infinite.
struct QuickLine {
  bool reversed = false;  // a and b are exchanged, so that a is the nearer
  Vector a;
  Vector b;
  Vector along;                           // b - a
  Vector cross;                           // a x b
  kernel::double_double::Bounded size;    // |a x b|
  kernel::double_double::Bounded weight;  // n . (a x b) / |a x b|
};

// A piece of an edge between two points: ends of the edge, or where the plane through x and another edge meets it. All
// by the numbers of their lines.
struct QuickPiece {
  static constexpr std::uint32_t kAtA = 0xFFFFFFFEU, kAtB = 0xFFFFFFFFU;
  std::uint32_t edge = 0;
  std::uint32_t begin = kAtA, end = kAtB;
};

class QuickContour {
 public:
  // n: the receiver's normal, finite and not zero, of any length.
  explicit QuickContour(const Vec3& normal);

  // The lines of as many edges.
  void make_lines(std::span<const QuickCorner> corners, std::span<const QuickEdge> edges,
                  std::span<QuickLine> lines) const;

  // The pieces may run against the sense from a to b. The lines are of this contour.
  void add(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines);

  // |F - (hi + lo)| <= error for the closed loops added so far, hi being the double nearest to hi + lo. The error is
  // infinite where some piece was declined: a and b, c and d, or p and q too close to one line with x, a crossing too
  // close to a or b, or corners too large or too small.
  struct Value {
    double hi = 0.0;
    double lo = 0.0;
    double error = 0.0;
  };
  [[nodiscard]] Value value() const;

 private:
  std::array<double, 3> normal_{};  // largest component in [1/2, 1)
  // Of the terms of the pieces, without the factor -1/(2 pi |n|): in lane k of every four the k-th.
  std::array<kernel::double_double::Bounded, 4> sums_;
};

}  // namespace exactff::contour
