// The settings of a study: sweeps of parameters.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "exactff/study.h"
#include "study/settings.h"

namespace exactff::study {
namespace {

TEST(Settings, DefaultsFollowTheLargestContribution) {
  Sweeps sweeps;
  complete(sweeps, {20.0, 100.0, true});
  EXPECT_EQ(sweeps.eps_b, (std::vector<double>{2, 0.2, 0.02, 0.002, 0.0002}));
  EXPECT_EQ(sweeps.eps_a.front(), 0.0);
  EXPECT_EQ(sweeps.eps_a[1], 10.0);
}

TEST(Settings, ASmallProductIsRunInFull) {
  Sweeps sweeps{{0.1, 0.01}, {0.0}, {4, 16}, {1, 2}, {SamplePattern::kJittered}, {Variant::kMended}};
  complete(sweeps, {});
  const SettingPlan plan = combine(sweeps);
  EXPECT_TRUE(plan.full_product);
  EXPECT_EQ(plan.settings.size(), 8U);
  EXPECT_EQ(plan.settings[plan.base].eps_b, 0.01);
  EXPECT_EQ(plan.settings[plan.base].rays, 16);
}

TEST(Settings, ALargeProductIsSweptThroughTheBase) {
  Sweeps sweeps;
  complete(sweeps, {1.0, 1.0, true});
  const SettingPlan plan = combine(sweeps);
  EXPECT_FALSE(plan.full_product);
  for (const Parameter p : {Parameter::kEpsB, Parameter::kRays, Parameter::kSeed, Parameter::kVariant}) {
    EXPECT_GE(line_through(plan.settings, plan.base, p).size(), 2U);
  }
  for (std::size_t i = 0; i < plan.settings.size(); ++i) {
    EXPECT_EQ(find_setting(plan.settings, plan.settings[i]), i) << "a setting occurs twice";
  }
}

TEST(Settings, WhatAPatternIgnoresMakesNoSetting) {
  Sweeps sweeps{{0.1}, {0.0}, {1, 4}, {1, 2, 3}, {SamplePattern::kCentre, SamplePattern::kRegular}, {Variant::kMended}};
  complete(sweeps, {});
  EXPECT_EQ(combine(sweeps).settings.size(), 3U);  // centre; regular with 1 and with 4 rays
}

TEST(Settings, RepetitionsAreDropped) {
  Sweeps sweeps{{0.1, 0.1}, {0.0}, {4}, {1}, {SamplePattern::kJittered}, {Variant::kMended}};
  complete(sweeps, {});
  EXPECT_EQ(sweeps.eps_b.size(), 1U);
}

TEST(Settings, WithNothingToSampleOnlyEpsBIsSwept) {
  Sweeps sweeps;
  complete(sweeps, {1.0, 1.0, false});
  const auto left_out = leave_out(sweeps, {1.0, 1.0, false});
  EXPECT_EQ(left_out.size(), 4U);
  EXPECT_EQ(sweeps.eps_b.size(), 5U);
  EXPECT_EQ(sweeps.rays.size() * sweeps.eps_a.size() * sweeps.seeds.size() * sweeps.patterns.size(), 1U);
}

TEST(Settings, ImpossibleValuesAreInputErrors) {
  const auto refused = [](Sweeps sweeps) {
    try {
      complete(sweeps, {1.0, 1.0, true});
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused({.eps_b = {-1.0}}));
  EXPECT_TRUE(refused({.eps_b = {std::numeric_limits<double>::infinity()}}));
  EXPECT_TRUE(refused({.eps_a = {-1.0}}));
  EXPECT_TRUE(refused({.rays = {0}}));
  EXPECT_TRUE(refused({.eps_b = {0.0}, .eps_a = {0.0}}));
  EXPECT_FALSE(refused({.eps_b = {0.0}, .eps_a = {0.1}}));
}

}  // namespace
}  // namespace exactff::study
