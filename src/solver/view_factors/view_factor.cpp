// The view factor from patch i to patch j.
//
//   A_i F_ij = integral over patch i of F(x -> j) dA,   upper - lower <= accuracy for F_ij and for F_ji = A_i F_ij /
//   A_j
//
// 1. Cut both patches into convex parts that do not overlap (patch_parts.h), once for all of their factors.
// 2. Of the parts that may see each other (seen_parts.h), cut one of each pair into cells (pair_choice.h, pair.h), so
//    that all points of a cell see the same corners and edges of the other (cell_view.h). No cells: F_ij is 0, proved.
// 3. Integrate F(x -> j) over each cell by Gauss' rules, with an error: an estimate (quadrature.h), or a bound where
//    the factor is to be certified (certified_integral.h).
// 4. Refine: halve the cell of the largest error until the sum of the errors is small enough (refinement.h).
// 5. If the cells do not suffice in a crowd of occluders, estimate the integral by statistics (sampled_factor.h).
// 6. Divide by A_i. A_i F_ij = A_j F_ji gives the factor of the other direction.
//
// Source: see exactff/view_factors.h.
#include "view_factors/view_factor.h"

#include <algorithm>
#include <utility>

#include "exactff/view_factors.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "view_factors/disc_space.h"
#include "view_factors/near_planes.h"
#include "view_factors/pair_memory.h"
#include "view_factors/pairs.h"
#include "view_factors/patch_parts.h"
#include "view_factors/refinement.h"
#include "view_factors/sampled_factor.h"

namespace exactff {
namespace view_factors {
namespace {

constexpr std::size_t kCellsOfAPoint = 4;  // that cost about as much as a point factor in a crowd

// What all of the patch sees, from the integral.
void take_interval(const Disc& integral, const PreparedPatch& from, ViewFactor& result) {
  const Disc f = integral / from.enclosed_area;
  result.lower = is_finite(f) ? std::clamp(lower_end(f), 0.0, 1.0) : 0.0;
  result.upper = is_finite(f) ? std::clamp(upper_end(f), 0.0, 1.0) : 1.0;
}

bool is_within(double accuracy, const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to) {
  const double width = f.upper - f.lower;
  return std::max(width, width * from.unit_area / to.unit_area) <= accuracy;
}

ViewFactor sampled(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to,
                   const ViewFactorOptions& options) {
  const double target = 0.5 * options.accuracy * std::min(1.0, to.unit_area / from.unit_area);
  const auto [value, error] = sampled_mean(scene, from.parts, to, options.budget / kCellsOfAPoint, target);
  ViewFactor result;
  result.area_from = from.area;
  result.area_to = to.area;
  result.value = std::clamp(value, 0.0, 1.0);
  result.lower = std::max(0.0, value - error);
  result.upper = std::min(1.0, value + error);
  result.claim = Claim::kEstimated;
  return result;
}

// If the cells of a crowd tell less than statistics. The points lie on the smaller patch, if A_i F_ij = A_j F_ji holds:
// the error of a mean over the larger one counts as many times as it is larger.
void sample_if_better(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to,
                      const ViewFactorOptions& options, ViewFactor& result) {
  const bool turned = is_symmetric(from, to, options) && to.unit_area < from.unit_area;
  const ViewFactor found =
      turned ? transpose(sampled(scene, to, from, options), to, from) : sampled(scene, from, to, options);
  if (!(found.upper - found.lower < result.upper - result.lower)) return;
  result.way = Way::kPoints;
  result.value = found.value;
  result.lower = found.lower;
  result.upper = found.upper;
  result.accurate = is_within(options.accuracy, result, from, to);
}

}  // namespace

bool is_symmetric(const PreparedPatch& i, const PreparedPatch& j, const ViewFactorOptions& options) {
  return i.planar && j.planar && !options.both_directions;
}

ViewFactor factor_between(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                          const PreparedPatch& to, const ViewFactorOptions& options, PairMemory& memory) {
  ViewFactor result;
  result.area_from = from.area;
  result.area_to = to.area;
  Refinement refinement(scene, seen, from, to, options, memory);
  result.cells = refinement.cells();
  if (refinement.is_zero()) return result;
  refinement.refine([&](const Disc& integral) {
    take_interval(integral, from, result);
    return result.accurate = is_within(options.accuracy, result, from, to);
  });
  result.cells = refinement.cells();
  result.event_cells = refinement.event_cells();
  result.claim = options.certify ? Claim::kCertified : Claim::kEstimated;
  result.value = std::clamp(refinement.estimate() / from.unit_area, result.lower, result.upper);
  if (!options.certify && !result.accurate && options.sample_crowds) {
    sample_if_better(scene, from, to, options, result);
  }
  return result;
}

ViewFactor transpose(const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to) {
  ViewFactor result = f;
  std::swap(result.area_from, result.area_to);
  if (f.claim == Claim::kZero) return result;
  const Disc ratio = from.enclosed_area / to.enclosed_area;
  if (!is_finite(ratio)) {
    result.lower = 0.0;
    result.upper = 1.0;
  } else {
    result.lower = std::clamp(lower_end(f.lower * ratio), 0.0, 1.0);
    result.upper = std::clamp(upper_end(f.upper * ratio), 0.0, 1.0);
  }
  result.value = std::clamp(f.value * (from.unit_area / to.unit_area), result.lower, result.upper);
  return result;
}

}  // namespace view_factors

std::string_view to_string(Claim claim) {
  switch (claim) {
    case Claim::kEstimated:
      return "estimated";
    case Claim::kCertified:
      return "certified";
    case Claim::kZero:
      return "zero";
  }
  return {};
}

std::string_view to_string(Way way) {
  switch (way) {
    case Way::kCells:
      return "cells";
    case Way::kPoints:
      return "points";
    case Way::kViews:
      return "views";
  }
  return {};
}

ViewFactor view_factor(const Scene& scene, const Selection& from, const Selection& to,
                       const ViewFactorOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  const view_factors::Pairs pair(scene, {&from, 1}, {&to, 1}, options);
  kernel::poll();
  ViewFactor result;
  pair.compute(0, [&](std::size_t, const ViewFactor& f) { result = f; });
  return result;
}

}  // namespace exactff
