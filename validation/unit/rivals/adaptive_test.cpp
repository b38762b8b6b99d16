#include "exactff/adaptive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "generate/families.h"
#include "unit/rivals/sampled_scenes.h"

namespace exactff::validation {
namespace {

using generate::PlainScene;

AdaptiveResult solve(const PlainScene& plain, const AdaptiveOptions& options, double rho_b = 1.0) {
  const Scene scene = generate::build(plain);
  const AdaptiveSolver solver(scene);
  return solver.form_factor(generate::receiver_of(plain), scene.select(plain.source), rho_b, options);
}

std::uint64_t count(const AdaptiveResult& result, LeafReason reason) {
  return result.leaves_by_reason[static_cast<std::size_t>(reason)];
}

double leaf_area(const Leaf& leaf) {
  const auto& c = leaf.corners;
  const Vec3 p{c[2].x - c[0].x, c[2].y - c[0].y, c[2].z - c[0].z};
  const Vec3& last = leaf.corner_count == 4 ? c[3] : c[2];
  const Vec3 q{last.x - c[1].x, last.y - c[1].y, last.z - c[1].z};
  return 0.5 * std::hypot(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x);
}

// Eq. (4) in double, for patches about as large as their distance: a few roundings per edge.
constexpr double kClosedFormBound = 64 * 0x1p-53;

TEST(Adaptive, AnUnoccludedSourceIsOneLeafOfEquationFour) {
  PlainScene plain;
  add(plain, "source", square_above(0.5, 1.0));
  const AdaptiveResult result = solve(plain, {});
  EXPECT_NEAR(result.form_factor, 0.239456470460773538825052152012, kClosedFormBound);
  EXPECT_EQ(result.leaves, 1U);
  EXPECT_EQ(count(result, LeafReason::kShaftEmpty), 1U);
  EXPECT_EQ(result.rays, 0U);
}

TEST(Adaptive, AFullyCoveredSourceIsOneCutShaft) {
  const AdaptiveResult result = solve(occluded_scene(0.75), {});
  EXPECT_EQ(result.form_factor, 0.0);
  EXPECT_EQ(result.leaves, 1U);
  EXPECT_EQ(count(result, LeafReason::kShaftCut), 1U);
  EXPECT_EQ(result.rays, 0U);
}

// The tiles hide the source only together, so only rays can find out.
TEST(Adaptive, AbuttingTilesAreFoundByRays) {
  const AdaptiveResult result = solve(generate::tiles({.n = 4}), {});
  EXPECT_EQ(result.form_factor, 0.0);
  EXPECT_EQ(count(result, LeafReason::kSampledHidden), 1U);
  EXPECT_EQ(result.rays, 16U);
}

TEST(Adaptive, StopsForEveryReason) {
  AdaptiveOptions options;
  options.eps_b = 1e-4;
  options.rays = 4;
  const PlainScene plain = generate::soup({.n = 30, .seed = 3});
  const AdaptiveResult free = solve(plain, options);
  for (const LeafReason reason : {LeafReason::kShaftEmpty, LeafReason::kShaftCut, LeafReason::kSampledVisible,
                                  LeafReason::kSampledHidden, LeafReason::kEpsF}) {
    EXPECT_GT(count(free, reason), 0U) << to_string(reason);
  }
  EXPECT_EQ(count(free, LeafReason::kEpsA) + count(free, LeafReason::kDepthCap), 0U);
  options.eps_a = 0.01;
  EXPECT_GT(count(solve(plain, options), LeafReason::kEpsA), 0U);
  options.eps_a = 0.0;
  options.depth_cap = 2;
  const AdaptiveResult capped = solve(plain, options);
  EXPECT_GT(count(capped, LeafReason::kDepthCap), 0U);
  EXPECT_EQ(capped.leaves_by_depth.size(), 3U);
}

// A picture of millions of leaves would take gigabytes.
TEST(Adaptive, RecordsTheLargestLeavesIfThereAreTooMany) {
  AdaptiveOptions options;
  options.eps_b = 1e-4;
  options.record_leaves = true;
  const PlainScene plain = generate::blinds({.n = 12});
  const AdaptiveResult all = solve(plain, options);
  options.most_recorded_leaves = all.leaves / 2;
  const AdaptiveResult some = solve(plain, options);
  EXPECT_EQ(some.leaves, all.leaves);
  EXPECT_EQ(some.form_factor, all.form_factor);
  std::uint64_t down_to_depth = 0;
  std::size_t depth = 0;
  for (; down_to_depth + all.leaves_by_depth[depth] <= all.leaves / 2; ++depth) {
    down_to_depth += all.leaves_by_depth[depth];
  }
  ASSERT_GT(down_to_depth, 0U);
  EXPECT_EQ(some.leaf_list.size(), down_to_depth);
  EXPECT_LT(std::ranges::max_element(some.leaf_list, {}, &Leaf::depth)->depth, static_cast<int>(depth));
}

TEST(Adaptive, LeavesTileTheSourceAndTheirSharesAddUp) {
  AdaptiveOptions options;
  options.eps_b = 1e-4;
  options.record_leaves = true;
  for (PlainScene plain : {occluded_scene(0.3), generate::soup({.n = 30, .seed = 3})}) {
    plain.point = {0.125, -0.25, 0.0};
    const AdaptiveResult result = solve(plain, options);
    double area = 0.0;
    double form_factor = 0.0;
    for (const Leaf& leaf : result.leaf_list) {
      area += leaf_area(leaf);
      form_factor += leaf.visibility * leaf.form_factor;
    }
    EXPECT_NEAR(area, 4.0, 1e-13);
    EXPECT_NEAR(form_factor, result.form_factor, 1e-14);
  }
}

TEST(Adaptive, TheHorizonClipsTheSourceFirst) {
  PlainScene plain;  // a wall half below the horizon; the upper half is C-14's perpendicular neighbour
  add(plain, "source", {{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}});
  plain.point = {0.5, 0.5, 0};
  AdaptiveOptions options;
  options.record_leaves = true;
  const AdaptiveResult result = solve(plain, options);
  EXPECT_NEAR(result.form_factor, 0.190136, 5e-7);
  ASSERT_EQ(result.leaf_list.size(), 1U);
  EXPECT_NEAR(leaf_area(result.leaf_list[0]), 1.0, 1e-15);
}

TEST(Adaptive, ToleranceIsDividedByRhoB) {
  AdaptiveOptions options;
  options.eps_b = 1e-2;
  const AdaptiveResult bright = solve(occluded_scene(0.3), options, 10.0);
  options.eps_b = 1e-3;
  const AdaptiveResult unit = solve(occluded_scene(0.3), options, 1.0);
  EXPECT_EQ(bright.form_factor, unit.form_factor);
  EXPECT_EQ(bright.leaves, unit.leaves);
}

TEST(Adaptive, TheRememberedFaceNeitherHidesNorShines) {
  PlainScene plain = occluded_scene(0.75);
  const Scene scene = generate::build(plain);
  const AdaptiveSolver solver(scene);
  Receiver receiver = generate::receiver_of(plain);
  receiver.on = {scene.faces_of(scene.select("occluder"))[0]};
  EXPECT_GT(solver.form_factor(receiver, scene.select("source"), 1.0, {}).form_factor, 0.5);
  receiver.on = {scene.faces_of(scene.select("source"))[0]};
  EXPECT_EQ(solver.form_factor(receiver, scene.select("source"), 1.0, {}).form_factor, 0.0);
}

// A face one unit in the last place in front of the source is an occluder.
TEST(Adaptive, CoplanarityIsExact) {
  PlainScene plain = open_scene();
  add(plain, "veil", square_above(2.0, std::nextafter(1.0, 0.0)));
  const AdaptiveResult result = solve(plain, {});
  EXPECT_EQ(count(result, LeafReason::kShaftEmpty), 0U);
  EXPECT_EQ(result.form_factor, 0.0);
}

// There are so many candidates that Embree is used, but single precision cannot separate these two faces from x and the
// source.
TEST(Adaptive, WhatSinglePrecisionCannotPlaceIsTestedInDouble) {
  const auto form_factor_with = [](const std::vector<Vec3>& face) {
    PlainScene changed = open_scene();  // behind slats with gaps of the same width
    for (int k = -100; k < 100; ++k) {
      const double y = 0.005 * k;
      add(changed, "slats", {{-0.6, y, 0.5}, {-0.6, y + 0.0025, 0.5}, {0.6, y + 0.0025, 0.5}, {0.6, y, 0.5}});
    }
    if (!face.empty()) add(changed, "face", face);
    return solve(changed, {}).form_factor;
  };
  const double slats = form_factor_with({});
  EXPECT_GT(slats, 0.2);
  EXPECT_EQ(form_factor_with(square_above(2.0, 0x1p-50)), 0.0);
  EXPECT_EQ(form_factor_with(square_above(2.0, -0x1p-50)), slats);
  EXPECT_EQ(form_factor_with(square_above(2.0, 0.0)), slats);
  EXPECT_EQ(form_factor_with(square_above(2.0, 1.0 - 0x1p-50)), 0.0);
  EXPECT_EQ(form_factor_with(square_above(2.0, 1.0 + 0x1p-50)), slats);
}

TEST(Adaptive, RepeatedFacesCountOnce) {
  PlainScene plain = open_scene();
  const double once = solve(plain, {}).form_factor;
  add(plain, "source", {{1, 1, 1}, {1, -1, 1}, {-1, -1, 1}, {-1, 1, 1}});  // the same ring, starting at another corner
  EXPECT_EQ(solve(plain, {}).form_factor, once);
}

TEST(Adaptive, IsReproducibleWhateverRanBefore) {
  const PlainScene plain = generate::soup({.n = 60, .seed = 5});
  const Scene scene = generate::build(plain);
  const AdaptiveSolver solver(scene);
  const AdaptiveSource source = solver.prepare(scene.select(plain.source));
  const Receiver receiver = generate::receiver_of(plain);
  Receiver other = receiver;
  other.point.x += 0.1;
  AdaptiveOptions options;
  options.eps_b = 1e-4;
  const AdaptiveResult first = solver.form_factor(receiver, source, 1.0, options);
  AdaptiveOptions coarse = options;
  coarse.rays = 5;
  coarse.pattern = SamplePattern::kLowDiscrepancy;
  (void)solver.form_factor(other, source, 1.0, coarse);
  const AdaptiveResult again = solver.form_factor(receiver, source, 1.0, options);
  AdaptiveResult elsewhere;
  std::thread([&] { elsewhere = solver.form_factor(receiver, source, 1.0, options); }).join();
  EXPECT_EQ(first.form_factor, again.form_factor);
  EXPECT_EQ(first.form_factor, elsewhere.form_factor);
  EXPECT_EQ(first.leaves_by_depth, elsewhere.leaves_by_depth);
  options.seed = 2;
  EXPECT_NE(first.form_factor, solver.form_factor(receiver, source, 1.0, options).form_factor);
}

// Scaling by a power of two changes no mantissa, and hence no sign, no ray and no sum.
TEST(Adaptive, ThePowerOfTwoInTheUnitOfLengthDoesNotMatter) {
  AdaptiveOptions options;
  options.eps_b = 1e-4;
  options.pattern = SamplePattern::kRegular;
  const PlainScene plain = generate::soup({.n = 30, .seed = 3});
  const double f = solve(plain, options).form_factor;
  for (const double factor : {0x1p-900, 0x1p-30, 0x1p30, 0x1p900}) {
    PlainScene scaled = plain;
    generate::scale(scaled, factor);
    EXPECT_EQ(solve(scaled, options).form_factor, f) << factor;
  }
}

TEST(Adaptive, RefusesWhatItCannotRun) {
  AdaptiveOptions options;
  options.rays = 0;
  EXPECT_THROW((void)solve(open_scene(), options), InputError);
  options.rays = 1;
  options.eps_b = -1.0;
  EXPECT_THROW((void)solve(open_scene(), options), InputError);
  PlainScene no_normal = open_scene();
  no_normal.normal = {0, 0, 0};
  EXPECT_THROW((void)solve(no_normal, {}), InputError);
}

// ---- The published listing -------------------------------------------------------------------------------------

AdaptiveOptions literal() {
  AdaptiveOptions options;
  options.variant = Variant::kLiteral;
  return options;
}

TEST(AdaptiveLiteral, DropsAPerpendicularWall) {
  PlainScene plain;
  add(plain, "source", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  plain.point = {0.5, 0.5, 0};
  EXPECT_EQ(solve(plain, literal()).form_factor, 0.0);
  EXPECT_NEAR(solve(plain, {}).form_factor, 0.190136, 5e-7);
}

TEST(AdaptiveLiteral, LosesDistantSources) {
  PlainScene plain;
  add(plain, "source", square_above(0.5, 1000.0));
  const double mended = solve(plain, {}).form_factor;
  EXPECT_GT(std::abs(solve(plain, literal()).form_factor / mended - 1.0), 0.05);
  PlainScene farther;
  add(farther, "source", square_above(0.5, 1e4));
  EXPECT_EQ(solve(farther, literal()).form_factor, 0.0);
  EXPECT_GT(solve(farther, {}).form_factor, 3e-9);
}

}  // namespace
}  // namespace exactff::validation
