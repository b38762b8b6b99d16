#include <thread>

#include "generate/families.h"
#include "support/test.h"
#include "unit/rivals/sampled_scenes.h"

namespace exactff::validation {
namespace {

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

TEST(Adaptive, RecordsTheLargestLeavesIfThereAreTooMany) {
  AdaptiveOptions options;
  options.eps_b = 1e-4;
  options.record_leaves = true;
  const PlainScene plain = generate::blinds({.n = 12});
  const AdaptiveResult all = solve(plain, options);
  options.most_recorded_leaves = all.leaves / 2;
  const AdaptiveResult some = solve(plain, options);
  EXPECT_EQ(some.form_factor, all.form_factor);
  EXPECT_EQ(some.leaves, all.leaves);
  ASSERT_FALSE(some.leaf_list.empty());
  EXPECT_LE(some.leaf_list.size(), all.leaves / 2);
  const int deepest = std::ranges::max_element(some.leaf_list, {}, &Leaf::depth)->depth;
  EXPECT_EQ(std::ranges::count_if(all.leaf_list, [&](const Leaf& leaf) { return leaf.depth <= deepest; }),
            std::ssize(some.leaf_list));
}

}  // namespace
}  // namespace exactff::validation
