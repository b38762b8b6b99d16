// Step 7 of the exact method (src/README.md), the first attempt at a certified value: translates the boundary that the
// edge engine found into corners, lines and pieces, and integrates these in double-double arithmetic
// (contour/quick_contour.h).
//
//   a. Give numbers to the lines of a batch of parts, and to their corners.
//   b. Make the lines that are new, four at a time.
//   c. Add the parts to the contour integral.
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
#include "visibility/plane_visibility.h"

namespace exactff::exact {

// --- Dense index ---

// Numbers items from 0 in the order in which they are first requested.

class DenseIndex {
 public:
  // Forgets all items. From now on, item i is below `count`.
  void clear(std::size_t count) {
    first_ = next_ = 0;
    number_.assign(count, kNone);
  }
  // The number of item i, and whether it is new.
  struct Found {
    std::uint32_t number;
    bool is_new;
  };
  Found find(std::uint32_t i) {
    const bool is_new = number_[i] == kNone || number_[i] < first_;
    if (is_new) number_[i] = next_++;
    return {number_[i] - first_, is_new};
  }
  // Starts again from 0, without clearing the table.
  void restart() { first_ = next_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::uint32_t first_ = 0, next_ = 0;
  std::vector<std::uint32_t> number_;
};

// --- Quick tier ---

class QuickTier {
 public:
  static constexpr int kBits = 106;  // precision of a double-double

  // Starts a new sum in the existing memory. `normal`: the receiver's.
  void start(const Vec3& normal);

  // Adds the boundary of one plane's visible region. Declines what the Booleans found.
  void add(const visibility::VisibleBoundary& boundary);

  // The same for another measure; `normal` as for MeasureIntegral::start. Between start() and ball().
  void add(const visibility::VisibleBoundary& boundary, const Measure& measure, const Vec3& normal);
  // Whether some of the parts added for a measure count. Not known if something was declined and nothing certainly
  // counts.
  [[nodiscard]] std::optional<bool> something_counts() const {
    return some_count_ ? std::optional(true) : some_are_unsure_ ? std::nullopt : std::optional(false);
  }

  // The term of each of these parts in Eq. (4), to be added by the caller.
  void find_terms(visibility::EdgeCovers& found, std::span<const visibility::EdgeCovers::Part> parts,
                  std::vector<kernel::double_double::Bounded>& terms);
  // The same for another measure.
  void find_terms(visibility::EdgeCovers& found, std::span<const visibility::EdgeCovers::Part> parts,
                  const Measure& measure, const Vec3& normal, std::vector<kernel::double_double::Bounded>& terms);
  // Encloses F, or the measure of the last call of find_terms, for a sum of terms.
  [[nodiscard]] Ball ball(const kernel::double_double::Bounded& sum) const;

  // Encloses F, or the measure; its radius is at least the proved error. The ball contains every number if anything was
  // declined.
  [[nodiscard]] Ball ball() const;

 private:
  template <class Take>
  void for_each_batch(visibility::EdgeCovers& found, std::span<const visibility::EdgeCovers::Part> parts,
                      const Take& take);
  [[nodiscard]] std::uint32_t number_of_line(visibility::Outlines& outlines, visibility::EdgeId id);
  [[nodiscard]] std::uint32_t number_of_corner(visibility::Outlines& outlines, visibility::CornerId id);
  void make_lines();
  void forget_lines();

  contour::QuickContour contour_;
  bool declined_ = false;
  // Of another measure than F.
  contour::QuickMeasure measure_;
  bool uses_measure_ = false;
  std::vector<kernel::double_double::Bounded> terms_;
  kernel::double_double::Bounded sum_;
  bool some_count_ = false, some_are_unsure_ = false;
  // Of the current plane.
  DenseIndex corner_index_, line_index_;
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
