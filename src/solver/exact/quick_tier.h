// Step 8 of the exact method (src/README.md), the first attempt at a certified value: integrates the arcs that the edge
// engine found (visibility/visible_arcs.h) in double-double arithmetic (contour/quick_contour.h).
//
//   a. Give numbers to the lines of a batch of arcs.
//   b. Make the lines that are new, four at a time.
//   c. Add the arcs to the contour integral.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contour/quick_contour.h"
#include "contour/quick_measures.h"
#include "exactff/exact.h"
#include "kernel/ball.h"
#include "visibility/visible_arcs.h"

namespace exactff::exact {

using kernel::double_double::Bounded;
using visibility::ArcSection;

// --- Quick tier ---

class QuickTier {
 public:
  static constexpr int kBits = 106;  // precision of a double-double

  // Starts a new sum in the existing memory. `normal`: the receiver's.
  void start(const Vec3& normal);

  // Adds what is seen of one plane. Declines what the Booleans found. Between start() and ball(), the measure is the
  // same.
  void add(const ArcSection& seen, const Measure& measure);
  // Whether some of the arcs added for a measure other than F count. Not known if something was declined and nothing
  // certainly counts.
  [[nodiscard]] std::optional<bool> something_counts() const {
    return some_count_ ? std::optional(true) : some_are_unsure_ ? std::nullopt : std::optional(false);
  }

  // The term of each arc in Eq. (4), or in the sum of another measure, to be added by the caller.
  void find_terms(const ArcSection& seen, const Measure& measure, std::vector<Bounded>& terms);
  // Encloses the measure of the last call of find_terms, for a sum of terms.
  [[nodiscard]] Ball ball(const Bounded& sum) const;

  // Encloses the measure; its radius is at least the proved error. The ball contains every number if anything was
  // declined.
  [[nodiscard]] Ball ball() const;

 private:
  template <class Take>
  void for_each_batch(const ArcSection& seen, const Take& take);
  [[nodiscard]] std::uint32_t number_of_line(const ArcSection& seen, std::uint32_t line);
  void make_lines();
  void forget_lines();

  contour::QuickContour contour_;
  bool declined_ = false;
  // Of another measure than F.
  contour::QuickMeasure measure_;
  bool uses_measure_ = false;
  std::vector<Bounded> terms_;
  Bounded sum_;
  bool some_count_ = false, some_are_unsure_ = false;
  // Of the current plane.
  visibility::DenseIndex line_index_;
  std::vector<contour::QuickCorner> corners_;
  std::vector<contour::QuickEdge> edges_;
  std::vector<contour::QuickLine> lines_;  // valid for the first `made_` edges; the rest is spare memory
  std::size_t made_ = 0;
  std::vector<contour::QuickPiece> pieces_;  // of the current batch
};

// --- Certified ---

// From balls to a certified value: its double, its bounds and its status. A Result has the members value, lower, upper,
// status, enclosure and precision_bits of a FormFactor; `most` is the largest double that a bound needs.

inline bool has_decimals(const Enclosure& enclosure, int digits) {
  return digits <= 0 || enclosure.decimals(digits).has_value();
}

// Takes the value from a ball computed with this precision. False if the ball does not determine the double and the
// requested decimals.
template <class Result>
bool is_determined(const Ball& ball, int bits, int digits, Result& result) {
  EnclosureInside::set(result.enclosure, ball);
  result.precision_bits = bits;
  const std::optional<double> nearest = result.enclosure.nearest();
  if (!nearest || !has_decimals(result.enclosure, digits)) return false;
  result.value = *nearest;
  result.status = result.value == 0.0 ? Status::kUnderflow : Status::kCertified;
  return true;
}

// Raises the precision until the ball determines the double and the requested decimals, or the cap is reached. The
// status refers to the double: decimals may stay undecided if F is a decimal tie, such as 1/8 to two digits.
template <class Evaluate, class Result>
void certify(const Evaluate& evaluate, int digits, int cap, Result& result, double most = 1.0) {
  constexpr int kFirstBits = 96;  // enough for all but the near-degenerate
  for (int bits = std::min(kFirstBits, cap);; bits = std::min(2 * bits, cap)) {
    const Ball ball = evaluate(bits);
    if (is_determined(ball, bits, digits, result)) return;
    if (bits < cap) continue;
    const std::optional<double> nearest = result.enclosure.nearest();
    result.value = nearest ? *nearest : std::clamp(kernel::nearest_to_midpoint(ball), 0.0, most);
    result.status = !nearest ? Status::kNotCertified : result.value == 0.0 ? Status::kUnderflow : Status::kCertified;
    return;
  }
}

// With very few bits a ball may contain every number; its midpoint and ends are then NaN.
template <class Result>
void set_bounds(Result& result, double most = 1.0) {
  if (result.status == Status::kZero) return;  // [0, 0]
  const bool certified = result.status != Status::kNotCertified;
  const double below = certified ? std::nextafter(result.value, -1.0) : result.enclosure.lower();
  const double above = certified ? std::nextafter(result.value, 20.0) : result.enclosure.upper();
  result.lower = std::isnan(below) ? 0.0 : std::clamp(below, 0.0, most);
  result.upper = std::isnan(above) ? most : std::clamp(above, 0.0, most);
  if (std::isnan(result.value)) result.value = 0.5 * (result.lower + result.upper);
}

}  // namespace exactff::exact
