// Tampieri's Eq. (4) in double-double arithmetic: tried first, before the ball arithmetic of contour.h, and more than
// ten times as fast. It may decline, but a bound that it gives is always valid. For a whole edge the error is about
// 2^-100 of the angle under which x sees the edge, however large that is. The error of a crossing is proportional to
// the edge. Hence F is rounded correctly unless its terms cancel by some 45 bits.
//
// Notation: as in contour.h, except that a piece of the edge from a to b is given by corners alone. a is the corner
// nearer to x, and d = b - a. If the plane through x and another edge, with the normal N, crosses the edge, the
// direction of the crossing is
//   s a + m d,  s : m = |N . d| : |N . a|,
// which is l a + m b with l = s - m. Hence w = s_p m_q - m_p s_q for the piece from p to q.
//
// Corners whose largest component is outside [2^-200, 2^200] are declined. So no operation overflows, and kUnderflow
// covers every underflow (double_double.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "exactff/geometry.h"
#include "kernel/bounded_vectors.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"

namespace exactff::contour {

using namespace kernel::double_double;
using kernel::double_double::where;  // beside those of this room

using QuickCorner = kernel::FineDirection;

// (vertex - x) * 2^scale_exponent, exact except for underflow; NaN if it overflows.
QuickCorner quick_corner(const Vec3& vertex, const Vec3& x, int scale_exponent);
// The direction, scaled so that its largest component is in [1/2, 1). Must not be zero.
QuickCorner quick_corner(const kernel::ExactVec3& direction);

// An edge from corner a to corner b, given by their indices.
struct QuickEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

// An edge with the quantities that all its pieces, and all edges crossed by its line, share. If the edge is declined,
// the errors of the last three members are infinite.
struct QuickLine {
  bool reversed = false;  // a and b were exchanged, so that a is the nearer one
  Vector a;
  Vector b;
  Vector along;    // b - a
  Vector cross;    // a x b
  Bounded size;    // |a x b|
  Bounded weight;  // n . (a x b) / |a x b|
};

// A piece of an edge between two points: ends of the edge, or points where the plane through x and another edge crosses
// it. Edges are given by the indices of their lines.
struct QuickPiece {
  static constexpr std::uint32_t kAtA = 0xFFFFFFFEU, kAtB = 0xFFFFFFFFU;
  std::uint32_t edge = 0;
  std::uint32_t begin = kAtA, end = kAtB;
};

class QuickContour {
 public:
  QuickContour() = default;  // of no receiver
  // `normal`: the receiver's normal, finite and not zero, of any length.
  explicit QuickContour(const Vec3& normal);

  // Computes the line of each edge; `lines` has the same length as `edges`.
  void make_lines(std::span<const QuickCorner> corners, std::span<const QuickEdge> edges,
                  std::span<QuickLine> lines) const;

  // Adds pieces. They may run from b towards a. `lines` must have been made by this contour.
  void add(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines);

  // The term of each piece instead, to be added by the caller; `terms` has the same length as `pieces`.
  void find_terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines, std::span<Bounded> terms) const;

  // |F - (hi + lo)| <= error for the closed loops added so far, where hi is the double nearest to hi + lo. The error is
  // infinite if a piece was declined: a and b, c and d, or p and q are too close to one line with x, a crossing is too
  // close to a or b, or corners are too large or too small.
  struct Value {
    double hi = 0.0;
    double lo = 0.0;
    double error = 0.0;
  };
  [[nodiscard]] Value value() const;
  // The same for a sum of terms.
  [[nodiscard]] Value value(const Bounded& sum) const;

 private:
  std::array<double, 3> normal_{};  // largest component in [1/2, 1)
  // Sums of the terms of the pieces, without the factor -1/(2 pi |n|): lane k has the k-th of every four.
  std::array<Bounded, 4> sums_;
};

// --- Quick gradient ---

// The sums of contour.h in double-double arithmetic: tried first. May decline, but a bound that it gives is always
// valid.
//
// Notation: as above, but corners are points of space, relative to x: a is the end of the edge nearer to
// x, b = a + d the other one. An edge is the image of the line through a and b, and with C = a x d its nearness is g =
// d x C / |C|^2, since g . d = 0 and g . a = C . (a x d) / |C|^2 = 1. Hence
//   n . g = (n x d) . C / |C|^2,   C . (w x g) = -(w . d)   for w in the plane of the edge,
// and 2 I of a piece from p to q (contour.h), with theta positive from a to b, is
// theta A + (psi(q) - psi(p)) / |C| with
//   A = (n x d) . C / |C|^2,   psi(w) = (w . n) (w . d) / w . w.
// Its terms are -C (theta A / |C| + (psi(q) - psi(p)) / |C|^2) for dF/dx and -C theta / |C| for V. They keep their form
// for a piece from b towards a, whose theta and difference are negative. V is a sum of vectors without units; dF/dx is
// proportional to 1 / length.

// A corner at which the line of a direction meets the plane { y : normal . y = offset }, offset > 0. The error is
// infinite if that is declined.
QuickCorner lifted(const QuickCorner& direction, const std::array<Bounded, 3>& normal, const Bounded& offset);

// x 2^exponent; declined where that is not certain to be exact.
[[nodiscard]] Bounded times_power(const Bounded& x, int exponent);

class QuickGradient {
 public:
  struct Line {
    bool reversed = false;
    Vector a, b, along, cross;
    Bounded size;          // |C|
    Bounded inverse;       // 1 / |C|
    Bounded growth;        // A / |C|
    Bounded psi_a, psi_b;  // of the ends
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
  // times 2^exponent. They are the sums of contour.h for the shares g_a = b x C / |C|^2 and g_b = C x a / |C|^2 of the
  // points (gradient/sight_lines.h), which add up to g:
  //   a: theta (n x b) . C / |C|^3 + (psi(q) - psi(p)) / |C|^2 with psi(w) = (w . n) (w . b) / w . w,
  //   b: the same with a for b, negated.
  struct Shares {
    Bounded a, b;
  };
  void find_shares(std::span<const QuickPiece> pieces, std::span<const Line> lines, std::span<Shares> shares) const;

  // As QuickContour::value, for each component.
  using Value = QuickContour::Value;
  [[nodiscard]] Value position(int axis) const;
  [[nodiscard]] Value normal(int axis) const;
  // F = n . V / |n|.
  [[nodiscard]] Value form_factor() const;
  // A sum of such parts, over 2 pi |n|.
  [[nodiscard]] Value over_turn_and_length(const Bounded& sum) const;

 private:
  std::array<double, 3> normal_{};  // largest component in [1/2, 1)
  std::array<Bounded, 3> position_{}, v_{};
};

}  // namespace exactff::contour
