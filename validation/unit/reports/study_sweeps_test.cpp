// The settings of a study: sweeps, and which of them a budget leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

#include "exactff/study.h"
#include "study/settings.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using validation::left_out_text;
using validation::small_request;
using validation::small_room;

// --- settings ---

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
  for (const char* parameter : {"eps_B", "rays", "seed", "variant"}) {
    EXPECT_GE(line_through(plan.settings, plan.base, parameter).size(), 2U) << parameter;
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

// --- the budget of the sweeps ---

TEST(SweepBudget, DropsTheDearestSettingsAndKeepsTheBase) {
  const Scene room = small_room(true);
  Request request = small_request(room, 1);
  request.sweeps.eps_b = {0.5, 0.05, 0.005};
  request.sweeps.eps_a = {0.0};
  request.sweeps.rays = {1, 16, 256};
  request.sweeps.seeds = {1};
  request.sweeps.patterns = {SamplePattern::kJittered};
  request.sweeps.variants = {Variant::kMended};
  const auto within = [&](double budget) {
    Request asked = request;
    asked.sweep_budget = budget;
    return run(std::move(asked));
  };
  const Study whole = within(1e9);
  ASSERT_EQ(whole.settings.size(), 9U);
  EXPECT_EQ(left_out_text(whole.left_out).find("--sweep-budget"), std::string::npos);
  std::set<std::size_t> counts;
  std::size_t before = 1;
  for (double budget = 0.0; budget < 1.0; budget = std::max(2.0 * budget, 1e-5)) {
    const Study study = within(budget);
    counts.insert(study.settings.size());
    EXPECT_GE(study.settings.size(), before);
    before = study.settings.size();
    EXPECT_EQ(study.settings[study.base], whole.settings[whole.base]);
    EXPECT_EQ(study.samples.size(), study.settings.size());
    const bool complete = study.settings.size() == 9;
    EXPECT_EQ(left_out_text(study.left_out).find("--sweep-budget") == std::string::npos, complete);
    AdaptiveOptions dearest = whole.settings[whole.base];
    dearest.eps_b = 0.005;
    dearest.rays = 256;
    EXPECT_EQ(find_setting(study.settings, dearest).has_value(), complete) << "it goes first";
  }
  EXPECT_TRUE(counts.contains(1) && counts.contains(9) && counts.size() > 3) << "some budgets are in between";
}

TEST(Settings, RepetitionsAreDropped) {
  Sweeps sweeps{{0.1, 0.1}, {0.0}, {4}, {1}, {SamplePattern::kJittered}, {Variant::kMended}};
  complete(sweeps, {});
  EXPECT_EQ(sweeps.eps_b.size(), 1U);
}

}  // namespace
}  // namespace exactff::study
