// View factors by statistics, for patches with so much in between that cells cost more.
//
// The receiver's parts are cut where other faces stand on them or pierce them, since F jumps there. Then random points
// tell the mean of their F (looks.h), of which nothing is assumed but what is proved (patch_bounds.h). The looks depend
// on the scene and the patches alone, not on the accuracy: with a smaller accuracy, there are only more.
//
// Rounding. The solver's receivers are doubles, a hair off the receiver's plane. Faces in this plane are their own, as
// they are for the exact point. Where a point has moved to the other side of a face that is nearly in this plane, and
// near it, only the largest F is used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "view_factors/patch_bounds.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

// The probability that the interval misses the factor: of all looks together.
inline constexpr double kRiskOfPatch = 0.5e-6;

// The mean of the point factor over the receiver. Deterministic.
class SampledMean {
 public:
  // Keeps references. `most`: points of all looks, but the first one is always allowed. `ratio`: how many times as wide
  // the interval counts for others.
  SampledMean(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to,
              std::size_t most, double ratio);
  ~SampledMean();
  SampledMean(const SampledMean&) = delete;
  SampledMean& operator=(const SampledMean&) = delete;

  // Whether looks could reach this width by this effort (Pair::effort), as far as is known. If not, none ever does:
  // where one is narrower, it is widened, by as little as can be.
  [[nodiscard]] bool may_reach(double width, std::uint64_t effort) const;
  // Takes the next look if the effort of all looks is then expected to be at most this. False if not.
  bool look(std::uint64_t effort);
  // Takes a last one of all points that are left, if it should be narrower than `width`.
  void look_with_the_rest(double width);

  // Of all looks so far.
  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] double lower() const { return lower_; }
  [[nodiscard]] double upper() const { return upper_; }

 private:
  class Looking;

  // What is proved of one of a few strata: the range at its middle, and the change to a corner, at the slope there.
  struct Sample {
    double share;  // of the area
    Span span;
  };
  struct Interval {
    double lower, upper;
  };

  [[nodiscard]] double width() const { return (upper_ - lower_) * ratio_; }
  // What the interval of a look at so many strata is hardly ever narrower than.
  [[nodiscard]] double least_width(double strata) const;
  void take_look();

  const ExactScene& scene_;
  const PreparedPatch& from_;
  const PreparedPatch& to_;
  std::size_t most_;
  double ratio_;
  double largest_;  // that the mean can be
  PatchBounds bounds_;
  std::vector<Sample> samples_;
  std::unique_ptr<Looking> looking_;  // made when asked for
  Interval known_;
  double value_, lower_, upper_;  // of the interval, widened
};

}  // namespace exactff::view_factors
