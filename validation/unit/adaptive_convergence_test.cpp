// The estimate against known values, within what sampling theory allows.
//
// Let the leaves be given. A leaf that n stratified rays judged errs by V' F instead of its visible form factor:
//   random    V' has mean V and variance at most V (1 - V) / n <= 1 / (4 n), independently of other leaves;
//   bias      V F weighs the leaf's area evenly where the kernel does not: at most F times half its relative range, and
//             only where V is neither 0 nor 1;
//   silent    a leaf wholly seen or wholly hidden but for the share d of its area is taken for such with probability at
//             most (1 - d)^n <= exp(-d n): d <= 15 / n but once in three million.
// Bound taken: five standard deviations of the first (once in two million), plus the sums of the other two. The seed is
// fixed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactff/adaptive.h"
#include "sampled_scenes.h"

namespace exactff::validation {
namespace {

using generate::PlainScene;

// cos^2 / r^2 up to a constant: the kernel for parallel planes at distance 1, at the corners of a leaf.
double half_relative_range(const Leaf& leaf) {
  double low = 1.0;
  double high = 0.0;
  for (int i = 0; i < leaf.corner_count; ++i) {
    const Vec3& c = leaf.corners[static_cast<std::size_t>(i)];
    const double squared = c.x * c.x + c.y * c.y + 1.0;
    low = std::min(low, 1.0 / (squared * squared));
    high = std::max(high, 1.0 / (squared * squared));
  }
  return 0.5 * (high / low - 1.0);
}

double error_bound(const AdaptiveResult& result, int rays) {
  double variance = 0.0;
  double bias = 0.0;
  double silent = 0.0;
  for (const Leaf& leaf : result.leaf_list) {
    const double f = leaf.form_factor;
    if (leaf.reason == LeafReason::kSampledVisible || leaf.reason == LeafReason::kSampledHidden) {
      silent += f * std::min(1.0, 15.0 / rays);
    } else if (leaf.reason == LeafReason::kEpsF) {
      variance += f * f / (4.0 * rays);
      bias += f * half_relative_range(leaf);
    }
  }
  return 5.0 * std::sqrt(variance) + bias + silent + 1e-15;
}

// The source in two parts, so that no edge of the occluder's shadow falls on a line of the subdivision.
PlainScene two_part_scene(double h) {
  PlainScene scene;
  add(scene, "source", {{-1, -1, 1}, {-1, 1, 1}, {0.1, 1, 1}, {0.1, -1, 1}});
  add(scene, "source", {{0.1, -1, 1}, {0.1, 1, 1}, {1, 1, 1}, {1, -1, 1}});
  add(scene, "occluder", square_above(h, 0.5));
  return scene;
}

struct Known {
  double half_size;
  double form_factor;
};
constexpr Known kKnown[] = {{0.25, 0.314669953518798448298026682526}, {0.125, 0.480648789167050624563809787804}};

AdaptiveResult solve(const PlainScene& plain, double eps_b, int rays, SamplePattern pattern) {
  const Scene scene = generate::build(plain);
  AdaptiveOptions options;
  options.eps_b = eps_b;
  options.rays = rays;
  options.pattern = pattern;
  options.record_leaves = true;
  return AdaptiveSolver(scene).form_factor(generate::receiver_of(plain), scene.select("source"), 1.0, options);
}

TEST(AdaptiveConvergence, StaysWithinTheStatisticalBound) {
  for (const Known& known : kKnown) {
    for (const PlainScene& plain : {occluded_scene(known.half_size), two_part_scene(known.half_size)}) {
      for (const double eps_b : {1e-1, 1e-2, 1e-3, 1e-4}) {
        for (const int rays : {4, 16, 64, 256}) {
          const AdaptiveResult result = solve(plain, eps_b, rays, SamplePattern::kJittered);
          EXPECT_NEAR(result.form_factor, known.form_factor, error_bound(result, rays)) << eps_b << ' ' << rays;
        }
      }
    }
  }
}

TEST(AdaptiveConvergence, TendsToTheTruth) {
  for (const Known& known : kKnown) {
    const AdaptiveResult result = solve(two_part_scene(known.half_size), 1e-5, 4096, SamplePattern::kJittered);
    EXPECT_LT(error_bound(result, 4096), 2e-3);
    EXPECT_NEAR(result.form_factor, known.form_factor, 1e-5);
  }
}

// Where the shadow's edges are lines of the subdivision, shaft culling and one look at each side suffice.
TEST(AdaptiveConvergence, IsExactOnceTheSubdivisionMeetsTheShadow) {
  for (const Known& known : kKnown) {
    const AdaptiveResult result = solve(occluded_scene(known.half_size), 1e-3, 16, SamplePattern::kJittered);
    EXPECT_NEAR(result.form_factor, known.form_factor, 1e-14);
  }
}

TEST(AdaptiveConvergence, EveryPatternConverges) {
  for (const SamplePattern pattern :
       {SamplePattern::kRegular, SamplePattern::kJittered, SamplePattern::kLowDiscrepancy}) {
    const AdaptiveResult result = solve(two_part_scene(0.25), 1e-4, 1024, pattern);
    EXPECT_NEAR(result.form_factor, kKnown[0].form_factor, 1e-4) << static_cast<int>(pattern);
  }
}

// One ray to the centre of each part never doubts: two leaves, both silently wrong.
TEST(AdaptiveConvergence, OneRayNeverSubdivides) {
  const AdaptiveResult result = solve(two_part_scene(0.25), 1e-6, 1, SamplePattern::kCentre);
  EXPECT_EQ(result.leaves, 2U);
  EXPECT_EQ(result.rays, 2U);
}

}  // namespace
}  // namespace exactff::validation
