// View factors by statistics, for patches with so much in between that cells cost more.
//
// The receiver's parts are cut where other faces stand on them or pierce them, since F jumps there. Then random points
// tell the mean of their F (interim_analyses.h), of which nothing is assumed but what is proved (factor_bounds.h). The
// analyses depend on the scene and the patches alone, not on the accuracy: with a smaller accuracy, there are only
// more.
//
// Rounding. The solver's receivers are doubles, a hair off the receiver's plane. Faces in this plane are their own, as
// they are for the exact point. Where a point has moved to the other side of a face that is nearly in this plane, and
// near it, only the largest F is used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "kernel/disc.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/refinement.h"

namespace exactff::view_factors {

// The probability that the interval misses the factor: of all analyses together.
inline constexpr double kRiskOfPatch = 0.5e-6;

// The mean of the point factor over the receiver. Deterministic.
class SampledMean {
 public:
  // Keeps references. `most`: points of all analyses, but the first one is always allowed. `ratio`: how many times as
  // wide the interval counts for others.
  SampledMean(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, std::size_t most,
              double ratio);
  ~SampledMean();
  SampledMean(const SampledMean&) = delete;
  SampledMean& operator=(const SampledMean&) = delete;

  // Whether analyses could reach this width by this effort (Pair::effort), as far as is known. If not, none ever does:
  // where one is narrower, it is widened, by as little as can be.
  [[nodiscard]] bool may_reach(double width, std::uint64_t effort) const;
  // Takes the next analysis if the effort of all analyses is then expected to be at most this. False if not.
  bool analyse(std::uint64_t effort);
  // Takes a last one of all points that are left, if it should be narrower than `width`.
  void analyse_with_the_rest(double width);

  // Of all analyses so far.
  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] double lower() const { return lower_; }
  [[nodiscard]] double upper() const { return upper_; }

 private:
  class Analysing;

  struct Interval {
    double lower, upper;
  };

  [[nodiscard]] double width() const { return (upper_ - lower_) * ratio_; }
  // What the interval of an analysis at so many strata is hardly ever narrower than.
  [[nodiscard]] double least_width(double strata) const;
  void take_analysis();

  const ExactScene& scene_;
  const PreparedPatch& from_;
  const PreparedPatch& to_;
  std::size_t most_;
  double ratio_;
  double largest_;  // that the mean can be
  PatchBounds bounds_;
  double range_;                          // the mean of its ranges, about
  std::unique_ptr<Analysing> analysing_;  // made when asked for
  Interval known_;
  double value_, lower_, upper_;  // of the interval, widened
};

// --- Sampled cells ---

// The integral over a refinement's cells (refinement.h), by random points on those that are not known.
//
// Refinement halves a cell until its error is small beside the sum of all, which takes very many cells where there are
// very many occluders: the lines of constant visibility are long, and their cells add up. Points need the largest error
// to be small, not the sum: of cells with equal errors, an interval of a hundredth of the sum takes a few thousand
// points, however many cells there are. So whenever the refinement pauses, analyses are taken (interim_analyses.h) at
// the cells of which only bounds are known, each with the point factor to its own part of the source. The integral over
// the others is added.
//
// What is done at a pause depends on the refinement's state alone, which does not depend on the accuracy: with a
// smaller one, there are only more pauses. All analyses of all pauses share the risk.
//
// Rounding. As above.

// The probability that the interval misses the factor: of all analyses together.
inline constexpr double kRiskOfCells = 0.5e-6;

class SampledCells {
 public:
  // Keeps references. `most`: points of all analyses.
  SampledCells(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, std::size_t most);

  // Takes analyses, each for a tenth of the width of what is known so far, until it is enough. They are expected to
  // take no more than this effort (Pair::effort).
  void analyse(const Refinement& cells, std::uint64_t effort,
               const std::function<bool(const kernel::Disc& integral)>& is_enough);
  // Takes one of all points that are left, if it should be narrower.
  void analyse_with_the_rest(const Refinement& cells);

  // The narrowest so far, by points or not, in squares of the unit of Point::at.
  [[nodiscard]] const kernel::Disc& enclosure() const { return narrowest_; }

 private:
  class FactorOfCells;
  class Round;

  // That the next analysis is for.
  [[nodiscard]] double next_radius() const;
  [[nodiscard]] std::size_t points_left() const { return most_ - std::min(most_, points_); }
  // At these cells, for the next radius, as far as is known.
  [[nodiscard]] double fewest_points(const Refinement::Apart& apart) const;
  void take_analysis(Round& round);

  const ExactScene& scene_;
  double smaller_area_;
  std::size_t most_;
  std::size_t analyses_ = 0, points_ = 0;  // so far
  std::uint64_t effort_of_point_;          // in the last round
  kernel::Disc narrowest_;
};

}  // namespace exactff::view_factors
