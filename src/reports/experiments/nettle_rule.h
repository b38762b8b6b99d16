// Nettle's rule: "the area of two interacting patches must be relatively small, when compared to the distance between
// them". How small must it be for a given error?
//
// A square patch is at distance 1 from the receiver. Both have random orientations but clearly face each other. The
// side of the patch varies. His factor from centre to centre is compared with the exact value: without an occluder, and
// with one whose straight edge crosses the patch, where the visibility scalar is exact or estimated by rays.
// Configurations come in independent groups, so that slopes have confidence intervals.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct NettleSize {
  std::vector<double> sides = geometric(1.0 / 64.0, 2.0, 15);  // side of the patch, divided by its distance
  std::vector<int> splits = {1, 2, 4, 8};
  int rays = 16;
  std::size_t groups = 8;
  int configurations = 24;  // in each group
  int orientations = 4096;  // number of unoccluded pairs of patches, for the sign of the cosines
};

enum class NettleCase {
  kFree,    // no occluder
  kExactV,  // the visibility scalar is the exact visible fraction
  kRayV,    // the visibility scalar is estimated by jittered rays
};

// Relative errors of one way of computation, against the side of the patch.
struct NettleCurve : ErrorCurve {
  NettleCase kind = NettleCase::kFree;
  int splits = 1;
  // The slope of the log-log line through the sides up to an eighth of the distance.
  [[nodiscard]] SlopeFit slope() const;
};
[[nodiscard]] std::vector<NettleCurve> nettle_curves(const NettleSize& size, int threads, const Hooks& hooks);

// What his text says literally, for unoccluded patches that are as large as the receiver's.
struct NettleLiteral {
  double side = 0.0;
  double sender_over_receiver = 0.0;  // median of literal value / exact value
  double receiver_over_sender = 0.0;
  double in_tenths = 0.0;  // sender over receiver again, with all lengths in units of a tenth
};
[[nodiscard]] std::vector<NettleLiteral> nettle_literal(const NettleSize& size, int threads, const Hooks& hooks);

// Of the pairs with random orientations: those with F = 0, and among them those for which the literal text gives more.
struct TurnedAway {
  std::size_t pairs = 0;
  std::size_t zero = 0;
  std::size_t literal_positive = 0;
};
[[nodiscard]] TurnedAway nettle_turned_away(const NettleSize& size);

[[nodiscard]] Result nettle_rule(const NettleSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result nettle_rule(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
