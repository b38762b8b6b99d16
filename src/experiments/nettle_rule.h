// Nettle's rule: "the area of two interacting patches must be relatively small, when compared to the distance between
// them". How small, for which error?
//
// A square patch at distance 1 from the receiver, both turned at random but well towards each other; the side of the
// patch varies. His factor from centre to centre is held against the exact value, without an occluder and with one
// whose straight edge crosses the patch, its visibility scalar exact or by rays. Configurations are drawn in groups
// that are independent of each other, so that a slope has a confidence interval.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct NettleSize {
  std::vector<double> sides = geometric(1.0 / 64.0, 2.0, 15);  // of the patch, over its distance
  std::vector<int> splits = {1, 2, 4, 8};
  int rays = 16;
  std::size_t groups = 8;
  int configurations = 24;  // in each group
  int orientations = 4096;  // of free pairs of patches, for the sign of the cosines
};

enum class NettleCase {
  kFree,    // no occluder
  kExactV,  // the visibility scalar is the exact visible fraction
  kRayV,    // by so many jittered rays
};

// Relative errors of one way of computing, against the patch's side.
struct NettleCurve {
  NettleCase kind = NettleCase::kFree;
  int splits = 1;
  std::vector<double> sides;
  std::vector<double> rms;
  std::vector<double> p95;                        // 95th percentile of magnitudes
  std::vector<std::vector<double>> rms_by_group;  // by group, then side
  [[nodiscard]] Points points() const;            // side, rms
  // Of the log-log line through the sides up to an eighth of the distance.
  [[nodiscard]] SlopeFit slope() const;
};
[[nodiscard]] std::vector<NettleCurve> nettle_curves(const NettleSize& size, int threads, const study::Hooks& hooks);

// What his text says to the letter, on free patches that are as large as the receiver's.
struct NettleLiteral {
  double side = 0.0;
  double sender_over_receiver = 0.0;  // median of the literal over the exact value
  double receiver_over_sender = 0.0;
  double in_tenths = 0.0;  // sender over receiver again, with all lengths measured in a tenth of the unit
};
[[nodiscard]] std::vector<NettleLiteral> nettle_literal(const NettleSize& size, int threads, const study::Hooks& hooks);

// Of pairs turned at random in all directions, those with F = 0, and among them those where the literal text says more.
struct TurnedAway {
  std::size_t pairs = 0;
  std::size_t zero = 0;
  std::size_t literal_positive = 0;
};
[[nodiscard]] TurnedAway nettle_turned_away(const NettleSize& size);

[[nodiscard]] Result nettle_rule(const NettleSize& size, int threads, const study::Hooks& hooks);
[[nodiscard]] Result nettle_rule(const Effort& effort, const study::Hooks& hooks);

}  // namespace exactff::experiments
