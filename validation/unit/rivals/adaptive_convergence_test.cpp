// Compares the estimate with known values, within the error that sampling theory allows.
//
// For given leaves, a leaf that n stratified rays judged contributes V' F instead of its visible form factor. The error
// has three parts:
//   random    V' has mean V and variance at most V (1 - V) / n <= 1 / (4 n), independently of other leaves;
//   bias      V F gives the same weight to all of the leaf, but the kernel varies: at most F times half its relative
//             range, and only if V is neither 0 nor 1;
//   silent    a leaf that is fully visible or fully hidden except for the share d of its area is judged uniform with a
//             probability of at most (1 - d)^n <= exp(-d n); d > 15 / n happens once in three million.
// The bound is five standard deviations of the random part (exceeded once in two million), plus the sums of the other
// two parts. The seed is fixed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactff/adaptive.h"
#include "unit/rivals/sampled_scenes.h"

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

// The source is in two parts, so that no edge of the occluder's shadow lies on a subdivision line.
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

// If the shadow's edges are subdivision lines, shaft culling and one ray to each side are sufficient.
TEST(AdaptiveConvergence, IsExactOnceTheSubdivisionMeetsTheShadow) {
  for (const Known& known : kKnown) {
    const AdaptiveResult result = solve(occluded_scene(known.half_size), 1e-3, 16, SamplePattern::kJittered);
    EXPECT_NEAR(result.form_factor, known.form_factor, 1e-14);
  }
}

}  // namespace
}  // namespace exactff::validation
