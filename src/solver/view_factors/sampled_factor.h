// View factors by statistics, for patches with so much in between that cells do not suffice.
//
// The receiver's parts are cut where other faces stand on them or pierce them, since F jumps there, and then into
// strata of about the same area. In each, two independent pairs or triples of points are drawn, whose mean is exact
// where F is linear. A point's F is the exact solver's (exact.h). strata.h has the points and the interval, which
// assumes nothing of F but that it is at most what distance and slope allow (factor_bound.h).
//
// Several looks, each at four times the strata of the one before, with points of its own, until one is accurate enough.
// Each has its share of the risk, so that all of them are right with a probability of 1 - kRisk: the narrowest is the
// result, and stopping early does no harm.
//
// Rounding. The solver's receivers are doubles, a hair off the receiver's plane. Faces in this plane are their own, as
// they are for the exact point. Where a point has moved to the other side of a face that is nearly in this plane, and
// near it, only the largest F is used. The shares of the strata are as wrong as their areas, whose roundings are
// enclosed.
#pragma once

#include "view_factors/patch_parts.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

inline constexpr double kRisk = 1e-6;  // of all looks together: the probability that the interval misses the factor

// The mean of the point factor over the receiver.
struct SampledMean {
  double value = 0.5;
  double error = 0.5;
};

// Takes some `budget` points, but at least 216; up to six times as many if the parts have many fragments. Stops at an
// error of `target`. Deterministic.
[[nodiscard]] SampledMean sampled_mean(const ExactScene& scene, const std::vector<Part>& parts, const PreparedPatch& to,
                                       std::size_t budget, double target);

}  // namespace exactff::view_factors
