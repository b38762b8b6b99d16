// What a comparison of methods runs: ladders of settings, at which receivers, in which order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "exactff/study.h"
#include "study/runs.h"
#include "study/settings.h"
#include "study/sight.h"
#include "support/complaint.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using validation::complaint;
using validation::left_out_text;

// --- ladders -------------------------------------------------------------------------------------------------

TEST(ParseLadder, TakesSeveralValuesOfOneSetting) {
  const Ladder ladder = parse_ladder(" area-sampling : pattern=stratified , samples = 4|16 | 64");
  EXPECT_EQ(ladder.name, "area, stratified");
  EXPECT_EQ(ladder.along, "samples");
  ASSERT_EQ(ladder.rungs.size(), 3U);
  for (const methods::Choice& rung : ladder.rungs) EXPECT_EQ(rung.settings.word("pattern"), "stratified");
  EXPECT_EQ(ladder.rungs[0].settings.whole("samples"), 4);
  EXPECT_EQ(ladder.rungs[2].settings.whole("samples"), 64);
  EXPECT_EQ(rung_text(ladder, 1), "16");
  EXPECT_EQ(rung_name(ladder, 1), "area, stratified, samples 16");
}

TEST(ParseLadder, DropsRepetitions) {
  EXPECT_EQ(parse_ladder("hemicube:resolution=64|32|64").rungs.size(), 2U);
  // The centre pattern has one ray, whatever the number of rays is set to.
  EXPECT_EQ(parse_ladder("adaptive:pattern=centre,rays=1|4|16").rungs.size(), 1U);
}

TEST(ParseLadder, NamesWhatItDoesNotKnow) {
  EXPECT_NE(complaint([] { (void)parse_ladder("hemicub:resolution=64|32"); }).find("hemicube"), std::string::npos);
  EXPECT_NE(complaint([] { (void)parse_ladder("hemicube:resolutions=64|32"); }).find("resolution"), std::string::npos);
  for (const char* wrong : {"", ":", "hemicube:", "hemicube:resolution", "hemicube:resolution=64|", "hemicube:=3",
                            "hemicube:resolution=64|x", "hemicube:resolution=64|33", "exact|hemicube"}) {
    EXPECT_NE(complaint([&] { (void)parse_ladder(wrong); }), "") << wrong;
  }
}

TEST(DefaultLadders, AreEveryMethodByRisingEffort) {
  const std::vector<Ladder> ladders = default_ladders(20.0);
  std::set<std::string> names, methods;
  for (const Ladder& ladder : ladders) {
    EXPECT_TRUE(names.insert(ladder.name).second) << ladder.name;
    methods.insert(ladder.rungs.front().method->name);
    EXPECT_EQ(ladder.rungs.size() == 1, ladder.along.empty()) << ladder.name;
  }
  EXPECT_EQ(methods, (std::set<std::string>{"exact", "adaptive", "adaptive-exact-visibility", "hemicube", "nettle",
                                            "wallace", "area-sampling"}));
  const auto adaptive = std::ranges::find(ladders, std::string("adaptive, 16 rays"), &Ladder::name);
  ASSERT_NE(adaptive, ladders.end());
  for (std::size_t k = 0; k < adaptive->rungs.size(); ++k) {
    EXPECT_NEAR(adaptive->rungs[k].settings.number("eps_B"), 2.0 * std::pow(10.0, -static_cast<double>(k)), 1e-12);
  }
}

TEST(LeaveOut, TakesLaddersThatCannotShowAnything) {
  const auto left = [](const Scope& scope) {
    std::vector<Ladder> ladders = default_ladders(1.0);
    const std::size_t all = ladders.size();
    const auto left_out = leave_out(ladders, scope);
    EXPECT_EQ(ladders.size() + left_out.size(), all);
    for (const LeftOut& item : left_out) {
      for (const Ladder& ladder : ladders) EXPECT_NE(item.what, "method " + ladder.name);
    }
    return left_out;
  };
  EXPECT_TRUE(left({1.0, 1.0, true, true}).empty());
  EXPECT_EQ(left({1.0, 1.0, false, false}).size(), default_ladders(1.0).size());
  EXPECT_EQ(left_out_text(left({1.0, 1.0, false, true})),
            "method adaptive, exact V: no receiver has a source hidden in part, so that there is no sampling to be "
            "replaced\n");
  EXPECT_EQ(left({0.0, 1.0, true, true}).size(), 5U) << "the adaptive ones";
}

// --- choices -------------------------------------------------------------------------------------------------

std::vector<ExactRow> rows_seeing(const std::vector<Sight>& sights) {
  std::vector<ExactRow> rows(sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i) rows[i].sight = sights[i];
  return rows;
}

TEST(ChooseReceivers, TakesAThirdFromThoseThatSeeAll) {
  std::vector<Sight> sights(100, Sight::kPartly);
  sights.insert(sights.end(), 100, Sight::kVisible);
  sights.insert(sights.begin(), 50, Sight::kHidden);
  const auto chosen = choose_receivers(rows_seeing(sights), 12);
  ASSERT_EQ(chosen.size(), 12U);
  EXPECT_TRUE(std::ranges::is_sorted(chosen));
  EXPECT_EQ(std::set(chosen.begin(), chosen.end()).size(), 12U);
  EXPECT_EQ(std::ranges::count_if(chosen, [](std::size_t i) { return i >= 150; }), 4);
  EXPECT_EQ(std::ranges::count_if(chosen, [](std::size_t i) { return i < 50; }), 0);
  EXPECT_EQ(chosen[0], 50U + 6U) << "evenly: the middles of eighths";
  EXPECT_EQ(chosen[7], 50U + 93U);
}

TEST(ChooseReceivers, TakesOthersWhereThereAreTooFew) {
  using enum Sight;
  EXPECT_EQ(choose_receivers(rows_seeing({kPartly, kVisible, kVisible, kVisible, kNothing}), 4),
            (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(choose_receivers(rows_seeing({kPartly, kPartly, kPartly, kVisible}), 100),
            (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(choose_receivers(rows_seeing({kPartly, kPartly, kPartly}), 3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(choose_receivers(rows_seeing({kHidden, kNothing}), 4).empty());
  EXPECT_TRUE(choose_receivers({}, 4).empty());
}

TEST(OrderOfTiming, HasTheSameShareOfPartlyHiddenFromTheStart) {
  std::vector<Sight> sights(60, Sight::kPartly);
  sights.insert(sights.end(), 30, Sight::kVisible);
  std::vector<std::size_t> all(90);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<std::size_t> order = order_of_timing(all, rows_seeing(sights));
  EXPECT_EQ(std::set(order.begin(), order.end()).size(), 90U);
  for (std::size_t first = 3; first <= 90; first += 3) {
    const auto partly = std::count_if(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(first),
                                      [](std::size_t i) { return i < 60; });
    EXPECT_NEAR(static_cast<double>(partly), 2.0 * static_cast<double>(first) / 3.0, 1.0) << first;
  }
}

TEST(SpreadOrder, IsAPermutationWhoseBeginningsAreSpread) {
  for (std::size_t count = 0; count < 300; ++count) {
    const auto order = spread_order(count);
    EXPECT_EQ(order.size(), count);
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), count);
    EXPECT_TRUE(order.empty() || *std::ranges::max_element(order) == count - 1);
  }
  for (const std::size_t count : {100, 256, 1024, 2310}) {
    const auto order = spread_order(count);
    for (std::size_t first = 8; first <= count; first *= 2) {
      std::vector<std::size_t> places(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(first));
      std::ranges::sort(places);
      std::size_t gap = places.front() + count - places.back();  // around the end
      for (std::size_t k = 1; k < first; ++k) gap = std::max(gap, places[k] - places[k - 1]);
      EXPECT_LE(gap, 6 * count / first) << first << " of " << count;
    }
  }
}

TEST(ParseLadder, RefusesTwoSettingsWithSeveralValues) {
  const std::string said = complaint([] { (void)parse_ladder("nettle:rays=1|4,splits=1|2"); });
  EXPECT_NE(said.find("'rays' and 'splits' of nettle both have several values"), std::string::npos) << said;
}

TEST(ParseLadder, RefusesSeveralSeeds) {
  const std::string said = complaint([] { (void)parse_ladder("area-sampling:seed=1|2"); });
  EXPECT_NE(said.find("--method-seeds"), std::string::npos) << said;
}

}  // namespace
}  // namespace exactff::study
