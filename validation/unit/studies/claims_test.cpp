// The study of our own claims, on few scenes.
#include "studies/honesty.h"
#include "support/test.h"

namespace exactff::experiments {
namespace {

const Hooks kUndisturbed;

HonestySize small_honesty() { return {.scenes = 12, .accuracies = {1e-1, 1e-4, 1e-8}, .budgets = {20, 100}}; }

std::string small_study(int threads, const Hooks& hooks) {
  return honesty_csv(honesty_study(small_honesty(), threads, hooks));
}

TEST(Claims, GiveTheSameBytesOfValuesForAnyNumberOfThreads) {
  EXPECT_EQ(small_study(1, kUndisturbed), small_study(3, kUndisturbed));
}

TEST(Claims, GiveUpWhenCancelled) {
  EXPECT_THROW((void)small_study(2, {{}, [] { return true; }}), Cancelled);
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
}

}  // namespace
}  // namespace exactff::experiments
