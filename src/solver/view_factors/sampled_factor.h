// View factors by statistics, for patches with so much in between that cells do not suffice.
//
// The receiver's parts are cut where other faces stand on them or pierce them, since F jumps there, and then into
// strata of about the same area. In each, two independent pairs or triples of points are drawn, whose mean is exact
// where F is linear. A point's F is the exact solver's (exact.h). strata.h has the points and the interval.
//
// Several looks, each at four times the strata of the one before, with points of its own, until one is accurate enough.
// Each has its share of the risk, so that with the whole level all of them are right: the narrowest is the result.
//
// Rounding. The solver's receivers are doubles, a hair off the receiver's plane. Faces in this plane are their own, as
// they are for the exact point. Where a point has moved to the other side of a face that is nearly in this plane, and
// near it, only 0 <= F <= 1 is used.
#pragma once

#include "view_factors/patch_parts.h"

namespace exactff::view_factors {

inline constexpr double kRisk = 1e-6;  // of all looks together: the probability that the interval misses the factor

// The integral of the point factor over the receiver, in squares of the unit of Point::at.
struct SampledIntegral {
  double value = 0.0;
  double error = 0.0;
};

// Takes some `budget` points, but at least 216; up to six times as many if the parts have many fragments. Stops at an
// error of `target`. Deterministic.
[[nodiscard]] SampledIntegral sampled_integral(const ExactScene& scene, const std::vector<Part>& parts,
                                               const Selection& to, std::size_t budget, double target);

}  // namespace exactff::view_factors
