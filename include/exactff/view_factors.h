// View factors from patch to patch, one at a time; matrix.h computes all between two lists of patches.
//
//   F_ij = (1 / A_i) * integral over patch i of F(x -> j) dA
//
// F(x -> j) is the form factor of exact.h from a point x of patch i to patch j, with all occluders in between. A patch
// of several faces counts as their union in every oriented plane. At a point of a face, this face does not occlude, and
// neither does what lies in its plane or behind it; every other face does, those of both patches included.
//
// Method. Patch i is cut into convex cells on which the visible boundary of patch j has the same corners and edges from
// every point. This is proved by exact signs at the cells' corners. F(x -> j) is then analytic inside a cell, and Gauss
// quadrature converges fast. What hides next to nothing from a cell, as the walls of a room do whose corners miss each
// other by roundings, is left out of its view; the bound of what it hides is part of the interval, also of a certified
// one. A scene far from the origin is first moved there, if that is exact. A factor depends on the scene, its two
// patches and the options alone, not on what else is computed.
// Source: G. Walton, "Calculation of Obstructed View Factors by Adaptive Integration", NISTIR 6925 (2002), for the
// problem; Tampieri's Eq. (4) for the point factor.
#pragma once

#include <cstddef>
#include <string_view>

#include "exactff/scene.h"

namespace exactff {

// An interval is proved or it is not.
enum class Claim {
  // The error is an estimate, with roundings counted: the factor lies in the interval as far as the rule's estimate of
  // its own error is right, or, by points, but with a probability of at most 1e-6.
  kEstimated,
  // Every step is proved: the visible boundary on every cell, the remainder of the quadrature, all roundings. Only on
  // request. An entry keeps this claim, and its width, if it misses its accuracy.
  kCertified,
  kZero,  // proved: no point of one patch sees a point of the other
};
[[nodiscard]] std::string_view to_string(Claim claim);  // "estimated", "certified", "zero"

// How a factor was found.
enum class Way {
  // By cells, on each of which the visible boundary is proved. The error of an estimated factor is four times what
  // three Gauss rules tell of it, or, closer to an edge than 1.5 radii of the cell, all that the point factor may be
  // there. Where the order of edges could not be decided on a cell (event cells), a bound is added.
  kCells,
  // Where cells would cost more: the mean of exact point factors over at least 100 strata, two points in each, of a
  // patch or of all cells that are not known well; others count as by kCells. The interval assumes nothing of the point
  // factor but what is proved: its largest value, and how fast it can change.
  kPoints,
};
[[nodiscard]] std::string_view to_string(Way way);  // "cells", "points"

// What ended the work on an entry that is wider than the accuracy.
enum class Limit {
  kNone,      // it is not, or a file does not tell
  kBudget,    // the limit of work, ViewFactorOptions::budget, is reached
  kCrowd,     // so much stands between that its cells would not fit into memory
  kRounding,  // what is left of the error are roundings of doubles
};
[[nodiscard]] std::string_view to_string(Limit limit);  // "none", "budget", "crowd", "rounding"

struct ViewFactorOptions {
  // Of F_ij and of F_ji: upper - lower is at most this. At the same budget, a smaller one never yields more.
  double accuracy = 1e-6;
  // The limit of work for an entry: the most cells, where one with many edges counts for several, and four points for
  // each, both of the patch and of its cells.
  std::size_t budget = 100000;
  bool sample_crowds = true;  // take points where they are expected to cost less than cells
  // Compute F_ij and F_ji apart, each by cells of its own patch, so that each tests the other. Otherwise, if all faces
  // are planar, one of them is computed, whichever is asked for, by cells of whichever patch seems to need fewer, and
  // A_i F_ij = A_j F_ji gives the other.
  bool both_directions = false;
  bool certify = false;  // enclose every factor: all claims are `certified` or `zero`, also in a crowd
};

struct ViewFactor {
  double value = 0.0;                     // F_ij, a pure number in [0, 1]
  double lower = 0.0, upper = 0.0;        // between planar patches, upper is at most A_j / A_i, since F_ji is at most 1
  double area_from = 0.0, area_to = 0.0;  // A_i, A_j, in the square of the scene's unit of length
  Claim claim = Claim::kZero;
  Way way = Way::kCells;
  bool accurate = true;  // within the accuracy asked for
  Limit limit = Limit::kNone;
  std::size_t cells = 0, event_cells = 0;
};

// The factor from one patch, or face, to another, or to itself. `lower` and `upper` are as strong as the claim. Throws
// InputError for a patch without area or an accuracy that is not positive and finite, and Cancelled.
[[nodiscard]] ViewFactor view_factor(const Scene& scene, const Selection& from, const Selection& to,
                                     const ViewFactorOptions& options = {});

}  // namespace exactff
