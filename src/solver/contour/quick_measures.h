// The other measures (measures.h, whose notation is used here) in double-double arithmetic: tried first, as Eq. (4) is
// in quick_contour.h, over the same lines and pieces. May decline, but a bound that it gives is always valid.
//
// For a piece with the line a x b and the factor w (quick_contour.h), C = w a x b, so that
//   |C| = |w| size,   n . C = w size weight,
// each with an error of about 2^-100 of the angle under which x sees the edge. theta and fan take the sign of w: the
// sums are odd in C. Hence, as for Eq. (4), the measure is rounded correctly unless its terms cancel by some 45 bits.
// Nothing else is proved here than in double_double.h: every operation counts its own error and those that it inherits.
// atan2 is that of the exact arguments, within the bound, wherever it does not decline (kernel/bounded_vectors.h), and
// the branch is right for the exact arguments (measures.h).
//
// Beside z's horizon, a piece is cut or left out only if the signs of z . p and z . q are certain, or the number is
// known to be 0: p is an end of the edge without an error, and each of its components or z's is 0. Otherwise
// it is declined. A cut piece has p or q replaced by c = |z . q| p + |z . p| q, and C multiplied by |z . p| or |z . q|,
// whichever is above. The arc from c to m, along the horizon, has C = (s / |z|) z with s = z . (c x m) / |z|, so its
// terms follow from s without dividing by |C|: c may have the direction of m.
#pragma once

#include <array>
#include <span>

#include "contour/measures.h"
#include "contour/quick_contour.h"

namespace exactff::contour {

// What the terms of one receiver share.
struct QuickMeasureFrame {
  MeasureTerms terms = MeasureTerms::kSolidAngle;
  Vector n, z;
  Bounded length_n, length_z;
  Bounded normal_up;                 // n . z
  Vector middle;                     // m
  Vector closing;                    // m x z
  Bounded closing_k;                 // n . z / |z|
  Bounded inverse_z;                 // 1 / |z|
  std::array<bool, 3> up_is_zero{};  // by component
};

class QuickMeasure {
 public:
  QuickMeasure() = default;
  // Requires a measure other than the form factor, and a normal as MeasureIntegral::start.
  QuickMeasure(const Measure& measure, const Vec3& n);

  [[nodiscard]] bool is_of(const Measure& measure, const Vec3& n) const { return measure == measure_ && n == n_; }

  // The term of each piece, to be added by the caller; `lines` must have been made by a QuickContour with the same
  // normal. A term is exactly 0 with an error of 0 if and only if nothing of the piece counts; it has an infinite error
  // if it was declined.
  void find_terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines, std::span<Bounded> terms) const;

  // As QuickContour::value, for a sum of terms.
  [[nodiscard]] QuickContour::Value value(const Bounded& sum) const;

 private:
  Measure measure_;
  Vec3 n_;
  QuickMeasureFrame frame_;
};

}  // namespace exactff::contour
