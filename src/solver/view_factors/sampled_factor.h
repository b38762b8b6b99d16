// View factors by statistics, for patches with so much in between that cells cost more.
//
// The receiver's parts are cut where other faces stand on them or pierce them, since F jumps there, and then into
// strata. In each, two independent points are drawn. A point's F is the exact solver's (exact.h). strata.h has the
// points, stratified_mean.h the interval, which assumes nothing of F but that it is at most what distance and slope
// allow (factor_bound.h). So strata are split where this, times their area, is the largest (split_strata.h). What a
// stratum has shown is the guess for the next look at its parts.
//
// Looks. Each look has points of its own, for an interval of a tenth of the width of the last one or, where the points
// were not enough, of the same width again; how many are needed is predicted from the bounds and from the last look.
// Look k has a share of kRisk / (k (k + 1)) of the risk, so that all of them are right with a probability of 1 - kRisk:
// the narrowest is the result, and it does no harm that the next look and the end depend on what has been seen. The
// looks depend on the scene and the patches alone, not on the accuracy: with a smaller accuracy, there are only more.
//
// Rounding. The solver's receivers are doubles, a hair off the receiver's plane. Faces in this plane are their own, as
// they are for the exact point. Where a point has moved to the other side of a face that is nearly in this plane, and
// near it, only the largest F is used. The shares of the strata are as wrong as their areas, whose roundings are
// enclosed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "view_factors/patch_parts.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

inline constexpr double kRisk = 1e-6;  // of all looks together: the probability that the interval misses the factor
inline constexpr std::size_t kPointsOfFirstLook = 216;  // more if the parts have many fragments

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

  // Whether looks could reach this width by this effort (Pair::effort), as far as is known. If not, none ever does:
  // where one is narrower, it is widened, by as little as can be.
  [[nodiscard]] bool may_reach(double width, std::uint64_t effort) const;
  // That the next look is for: a power of ten.
  [[nodiscard]] double next_width() const;
  // Takes the next look if the effort of all looks is then expected to be at most this. False if not.
  bool look(std::uint64_t effort);
  // Takes a last one of all points that are left, if it should be narrower than `width`.
  void look_with_the_rest(double width);

  // Of the narrowest look so far.
  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;

 private:
  class Looks;

  [[nodiscard]] double width() const { return (upper() - lower()) * ratio_; }
  void take_look();

  const ExactScene& scene_;
  const PreparedPatch& from_;
  const PreparedPatch& to_;
  std::size_t most_;
  double ratio_, width_of_one_;   // of one stratum; that of several is as many times smaller
  std::unique_ptr<Looks> looks_;  // made when asked for
  double value_ = 0.5, error_ = 0.5;
};

}  // namespace exactff::view_factors
