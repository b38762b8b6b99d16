// The studies of our own claims, each on a scene that is small enough for a test.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "experiments/experiments.h"
#include "studies/honesty.h"
#include "studies/view_factors.h"
#include "studies/whole_view_times.h"

namespace exactff::experiments {
namespace {

const Hooks kUndisturbed;

HonestySize small_honesty() { return {.scenes = 12, .accuracies = {1e-1, 1e-4, 1e-8}, .budgets = {20, 100}}; }

struct SmallStudy {
  const char* name;
  std::function<Result(int threads, const Hooks&)> run;
};

std::vector<SmallStudy> small_studies() {
  const auto whole_view = [](int, const Hooks& hooks) {
    return whole_view_times({.triangles = {5, 20}, .models = {{"closed-room:boxes=1", "floor"}}, .points = 2}, hooks);
  };
  const auto honesty = [](int threads, const Hooks& hooks) {
    return honesty_chapter(honesty_study(small_honesty(), threads, hooks), small_honesty());
  };
  const auto factors = [](int threads, const Hooks& hooks) {
    return view_factors({.accuracies = {1e-3}}, threads, hooks);
  };
  return {{"whole view", whole_view}, {"honesty", honesty}, {"view factors", factors}};
}

std::string bytes_of_values(const Result& result) {
  std::string text;
  for (const CsvFile& table : result.values) text += table.file + '\n' + table.csv;
  return text;
}

TEST(Claims, GiveTheSameBytesOfValuesForAnyNumberOfThreads) {
  for (const SmallStudy& small : small_studies()) {
    const Result one = small.run(1, kUndisturbed);
    EXPECT_FALSE(one.paragraphs.empty()) << small.name;
    EXPECT_FALSE(one.values.empty()) << small.name;
    EXPECT_EQ(bytes_of_values(one), bytes_of_values(small.run(3, kUndisturbed))) << small.name;
    for (const page::Figure& figure : one.figures) EXPECT_FALSE(figure.script.empty()) << figure.id;
  }
}

TEST(Claims, GiveUpWhenCancelled) {
  Hooks hooks;
  hooks.cancelled = [] { return true; };
  for (const SmallStudy& small : small_studies()) EXPECT_THROW((void)small.run(2, hooks), Cancelled) << small.name;
}

TEST(WholeViewTimes, SeeAsManyTrianglesAsTheSolverAndAddUpToOne) {
  const std::vector<WholeViewRow> rows = whole_view_rows(
      {.triangles = {30, 200}, .models = {{"closed-room:boxes=2", "ceiling"}}, .points = 3}, kUndisturbed);
  ASSERT_EQ(rows.size(), 5U);
  for (const WholeViewRow& row : rows) EXPECT_TRUE(row.holds_one) << row.scene;
  EXPECT_EQ(rows[0].seen, work_row(30, false).visible + 1);  // and the source behind them
  EXPECT_EQ(rows[1].seen, work_row(200, false).visible + 1);
  EXPECT_GT(rows[2].open, 0.05);
  EXPECT_EQ(rows[4].open, 0.0);
}

TEST(ViewFactorChapter, TellsWidthsClaimsAndSums) {
  const ViewFactorStudy study = view_factor_study({.accuracies = {1e-2, 1e-6}, .budget = 100}, 1, kUndisturbed);
  ASSERT_EQ(study.curves.size(), 4U);
  EXPECT_EQ(study.curves.front().claim, Claim::kCertified);
  for (const WidthCurve& curve : study.curves) {
    for (const WidthAtAccuracy& place : curve.places) EXPECT_LE(place.width, place.accuracy) << curve.name;
  }
  EXPECT_GE(study.curves[0].places[0].width, study.curves[0].places[1].width);
  ASSERT_EQ(study.sums.size(), 12U);
  for (std::size_t i = 0; i < study.sums.size(); ++i) {
    EXPECT_LE(study.sums[i].lower, 1.0) << study.patches[i];
    EXPECT_GE(study.sums[i].upper, 1.0) << study.patches[i];
  }
  // The cube's sides see no side of the cube; with so few cells, some pairs of walls are crowds.
  for (std::size_t i = 6; i < 12; ++i) {
    for (std::size_t j = 6; j < 12; ++j) EXPECT_EQ(study.matrix.at(i, j).claim, Claim::kZero);
  }
  EXPECT_NE(std::ranges::count(study.matrix.entries, Way::kPoints, &ViewFactor::way), 0);
  const Result chapter = view_factors({.accuracies = {1e-2}, .budget = 100}, 1, kUndisturbed);
  EXPECT_EQ(chapter.figures.size(), 3U);
  EXPECT_NE(chapter.paragraphs.front().find("every one of 12 rows"), std::string::npos);
}

TEST(Honesty, CountsAnErrorOnlyIfItIsProved) {
  const ViewFactor entry{.value = 0.5, .lower = 0.4, .upper = 0.6};
  EXPECT_EQ(verdict(entry, {0.45, 0.55}), Verdict::kHolds);
  EXPECT_EQ(verdict(entry, {0.4, 0.6}), Verdict::kHolds);
  EXPECT_EQ(verdict(entry, {0.55, 0.65}), Verdict::kOpen);
  EXPECT_EQ(verdict(entry, {0.3, 0.7}), Verdict::kOpen);
  EXPECT_EQ(verdict(entry, {0.6, 0.7}), Verdict::kOpen);
  EXPECT_EQ(verdict(entry, {0.61, 0.7}), Verdict::kBroken);
  EXPECT_EQ(verdict(entry, {0.1, 0.39}), Verdict::kBroken);
  EXPECT_NEAR(error_ratio(entry, {0.65, 0.7}).at_least, 1.5, 1e-12);
  EXPECT_NEAR(error_ratio(entry, {0.65, 0.7}).at_most, 2.0, 1e-12);
  EXPECT_EQ(error_ratio(entry, {0.45, 0.52}).at_least, 0.0);
  EXPECT_NEAR(error_ratio(entry, {0.45, 0.52}).at_most, 0.5, 1e-12);
}

TEST(Honesty, NoErrorExceedsTheReportedOneInAFewScenes) {
  HonestyStudy study = honesty_study({.first = 31, .scenes = 20, .budgets = {30, 100}}, 1, kUndisturbed);
  EXPECT_EQ(study.contradictions, 0U);
  EXPECT_EQ(study.failures, 0U);
  std::size_t entries = 0, holds = 0;
  for (const HonestyRow& row : study.rows) {
    EXPECT_EQ(row.broken, 0U) << to_string(row.claim) << ' ' << row.accuracy;
    EXPECT_LE(row.worst.at_most, 1.0 + 1e-12) << to_string(row.claim) << ' ' << row.accuracy;
    EXPECT_EQ(row.entries, row.holds + row.open);
    entries += row.entries;
    holds += row.holds;
  }
  EXPECT_GE(holds, entries * 8 / 10);
  EXPECT_GE(study.rows.size(), 10U);
  // The same entries beside a value that is not theirs.
  for (HonestyScene& scene : study.scenes) {
    for (HonestyEntry& entry : scene.entries) {
      for (double* end : {&entry.factor.value, &entry.factor.lower, &entry.factor.upper}) *end += 2.0;
    }
  }
  study.rows = honesty_rows(study.scenes);
  for (const HonestyRow& row : study.rows) EXPECT_EQ(row.broken, row.entries);
  const std::string said = honesty_chapter(study, {}).paragraphs.front();
  EXPECT_NE(said.find(std::to_string(entries) + " of " + std::to_string(entries) + " view factors"), std::string::npos)
      << said;
  EXPECT_NE(said.find("estimated by points"), std::string::npos) << said;
}

}  // namespace
}  // namespace exactff::experiments
