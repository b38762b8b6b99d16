// View factors by statistics, for patches with so much in between that cells cost more.
//
// The receiver's parts are cut where other faces stand on them or pierce them, since F jumps there. Then random points
// tell the mean of their F (looks.h), of which nothing is assumed but that it is at most what distance and slope allow
// (factor_bound.h). The looks depend on the scene and the patches alone, not on the accuracy: with a smaller accuracy,
// there are only more.
//
// Rounding. The solver's receivers are doubles, a hair off the receiver's plane. Faces in this plane are their own, as
// they are for the exact point. Where a point has moved to the other side of a face that is nearly in this plane, and
// near it, only the largest F is used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

// The probability that the interval misses the factor: of all looks together.
inline constexpr double kRiskOfPatch = 0.5e-6;

// The mean of the point factor over the receiver. Deterministic.
class SampledMean {
 public:
  // Keeps references. `most`: points of all looks, but the first one is always allowed. `ratio`: how many times as wide
  // the interval counts for others.
  SampledMean(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, std::size_t most,
              double ratio);
  ~SampledMean();
  SampledMean(const SampledMean&) = delete;
  SampledMean& operator=(const SampledMean&) = delete;

  // Of what is known before any look, as others count it: F lies between 0 and the bounds at a few places.
  [[nodiscard]] double first_width() const { return range_ * ratio_; }
  // Whether looks could reach this width by this effort (Pair::effort), as far as is known. If not, none ever does:
  // where one is narrower, it is widened, by as little as can be.
  [[nodiscard]] bool may_reach(double width, std::uint64_t effort) const;
  // Takes the next look if the effort of all looks is then expected to be at most this. False if not.
  bool look(std::uint64_t effort);
  // Takes a last one of all points that are left, if it should be narrower than `width`.
  void look_with_the_rest(double width);

  // Of the narrowest look so far.
  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;

 private:
  class Looking;

  [[nodiscard]] double width() const { return (upper() - lower()) * ratio_; }
  void take_look();

  const ExactScene& scene_;
  const PreparedPatch& from_;
  const PreparedPatch& to_;
  std::size_t most_;
  double ratio_, range_;
  std::unique_ptr<Looking> looking_;  // made when asked for
  double value_ = 0.5, error_ = 0.5;
};

}  // namespace exactff::view_factors
