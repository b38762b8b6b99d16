// What a check finds: errors, their statistics and histogram, and verdicts on criteria.
#include "exactff/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "check/report.h"
#include "support/complaint.h"
#include "unit/products/check_support.h"

namespace exactff::check {
namespace {

using validation::complaint;

// --- Errors ---

TEST(Difference, IsTheValueMinusTheTruth) {
  const Difference d = difference(0.75, 0.5);
  EXPECT_EQ(d.error, 0.25);
  EXPECT_EQ(d.relative, 0.5);
  EXPECT_EQ(difference(0.25, 0.5).error, -0.25);
  EXPECT_EQ(difference(0.25, 0.5).relative, 0.5);
}

TEST(Difference, CountsDoubles) {
  EXPECT_EQ(difference(1.0, 1.0).ulps, 0.0);
  EXPECT_EQ(difference(std::nextafter(1.0, 2.0), 1.0).ulps, 1.0);
  EXPECT_EQ(difference(std::nextafter(1.0, 0.0), 1.0).ulps, 1.0);
  EXPECT_EQ(difference(-5e-324, 5e-324).ulps, 2.0);
  EXPECT_EQ(difference(-0.0, 0.0).ulps, 0.0);
  EXPECT_EQ(difference(kInfinity, 0.5).ulps, kInfinity);
}

TEST(Difference, IsRelativelyInfiniteWhereTheTruthIsZeroAndTheValueIsNot) {
  EXPECT_EQ(difference(0.0, 0.0).relative, 0.0);
  EXPECT_EQ(difference(1e-300, 0.0).relative, kInfinity);
}

// An uncertainty of the truth does not count as an error.
TEST(Difference, OfATruthThatIsNotCertifiedIsTheDistanceToItsEnclosure) {
  TruthRow row = row_of("a", 0.5);
  row.lower = 0.4;
  row.upper = 0.6;
  EXPECT_EQ(difference(0.55, row).error, 0.55 - 0.5);  // certified: the bounds are only the neighbours
  row.status = Status::kNotCertified;
  EXPECT_EQ(difference(0.55, row).error, 0.0);
  EXPECT_EQ(difference(0.55, row).relative, 0.0);
  EXPECT_EQ(difference(0.75, row).error, 0.75 - 0.6);
  EXPECT_EQ(difference(0.25, row).error, 0.25 - 0.4);
  EXPECT_EQ(difference(0.25, row).relative, (0.4 - 0.25) / 0.4);
  EXPECT_TRUE(std::isnan(difference(std::nan(""), row).error));
}

TEST(Tolerance, IsKeptByEitherPart) {
  EXPECT_TRUE(is_near(0.75, 0.5, 0.25));
  EXPECT_FALSE(is_near(0.75, 0.5, 0.2));
  EXPECT_TRUE(is_near(0.75, 0.5, relative(0.5)));
  EXPECT_FALSE(is_near(0.75, 0.5, relative(0.4)));
  EXPECT_TRUE(is_near(0.75, 0.5, {0.2, 0.5}));
  EXPECT_FALSE(is_near(std::nan(""), 0.5, 1e300));
  EXPECT_FALSE(is_near(kInfinity, 0.5, 1e300));
}

// --- Statistics ---

TEST(CheckStatistics, AreByNearestRank) {
  std::vector<double> truth(1000, 0.0), values;
  for (int i = 1; i <= 1000; ++i) values.push_back(i);
  const Distribution d = judged(truth, values).overall.absolute;
  EXPECT_EQ(d.median, 500.0);
  EXPECT_EQ(d.p90, 900.0);
  EXPECT_EQ(d.p99, 990.0);
  EXPECT_EQ(d.p999, 999.0);
  EXPECT_EQ(d.max, 1000.0);
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt(1001.0 * 2001.0 / 6.0));
}

TEST(CheckStatistics, TellBiasWithItsSignAndLeaks) {
  const Statistics s = judged({0.5, 0.5, 0.0, 0.0}, {0.25, 0.5, 0.125, 0.0}).overall;
  EXPECT_EQ(s.bias, -0.125 / 4.0);
  EXPECT_EQ(s.leaks, 1U);
  EXPECT_EQ(s.relative.max, kInfinity);
  EXPECT_EQ(s.largest_value, 0.5);
}

TEST(CheckStatistics, LeaveOutWhatIsNotFinite) {
  const Report report = judged({0.5, 0.5, 0.5}, {0.5, std::nan(""), kInfinity}, {.max_abs = 0.0});
  EXPECT_EQ(report.overall.rows, 3U);
  EXPECT_EQ(report.overall.not_finite, 2U);
  EXPECT_EQ(report.overall.absolute.max, 0.0);
  EXPECT_TRUE(verdict_on(report, "max-abs").passed);
  EXPECT_FALSE(verdict_on(report, "finite").passed);
  EXPECT_FALSE(report.passed());
  ASSERT_EQ(report.worst.size(), 2U);
  EXPECT_EQ(report.worst.front().receiver, "2");
}

// --- Verdicts ---

TEST(Criteria, AreKeptByErrorsEqualToTheirLimits) {
  const Criteria criteria{.max_abs = 0.25, .max_rel = 0.5, .rms = 0.25, .quantiles = {{0.5, 0.25}}};
  const Report report = judged({0.5, 0.5}, {0.75, 0.25}, criteria);
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.verdicts.size(), 5U);
}

TEST(Criteria, AreBrokenByTheNextDouble) {
  const double limit = std::nextafter(0.25, 0.0);
  for (const Criteria& criteria : {Criteria{.max_abs = limit}, Criteria{.max_rel = std::nextafter(0.5, 0.0)},
                                   Criteria{.rms = limit}, Criteria{.quantiles = {{0.5, limit}}}}) {
    const Report report = judged({0.5, 0.5}, {0.75, 0.25}, criteria);
    EXPECT_FALSE(report.passed());
    EXPECT_TRUE(report.verdicts.front().passed);
    EXPECT_FALSE(report.verdicts.back().passed) << report.verdicts.back().criterion;
  }
}

TEST(Criteria, OfAQuantileAllowForTheRest) {
  std::vector<double> truth(100, 0.5), values(100, 0.5);
  values[7] = 0.75;
  EXPECT_TRUE(judged(truth, values, {.quantiles = {{0.99, 0.0}}}).passed());
  EXPECT_FALSE(judged(truth, values, {.quantiles = {{1.0, 0.0}}}).passed());
  values[8] = 0.625;
  EXPECT_FALSE(judged(truth, values, {.quantiles = {{0.99, 0.0}}}).passed());
  EXPECT_TRUE(judged(truth, values, {.quantiles = {{0.98, 0.0}, {0.99, 0.125}}}).passed());
}

TEST(Criteria, OfEpsBBoundTheErrorTimesRhoB) {
  Truth truth = truth_with({0.5, 0.0});
  const std::vector<double> values = {0.5, 0.125};
  EXPECT_HOLDS(complaint([&] { (void)judge(truth, values, {.eps_b = 1.0}); }), "does not contain rho B for every row");
  truth.rows[0].largest_rho_b = 100.0;
  truth.rows[1].largest_rho_b = 8.0;
  EXPECT_TRUE(judge(truth, values, {.eps_b = 1.0}).passed());
  const Report report = judge(truth, values, {.eps_b = 0.9});
  EXPECT_EQ(verdict_on(report, "eps-b").measured, 1.0);
  EXPECT_EQ(verdict_on(report, "eps-b").worst->receiver, "2");
  EXPECT_EQ(report.worst_by, Measure::kRadiosity);
}

TEST(Criteria, PerSourceAreKeptByEverySource) {
  const Truth truth = truth_of_two({0.5, 0.5}, {0.25, 0.25});
  const std::vector<double> values{0.5, 0.375, 0.5, 0.25};
  EXPECT_TRUE(judge(truth, values, {.rms = 0.07}).passed());  // 0.125 / 2 over all
  const Report report = judge(truth, values, {.rms = 0.07, .per_source = true});
  EXPECT_TRUE(verdict_on(report, "rms", "s").passed);
  EXPECT_FALSE(verdict_on(report, "rms", "t").passed);
}

TEST(Criteria, AreRefusedIfTheyAreNone) {
  const auto refused = [](const Criteria& criteria) {
    return complaint([&] { (void)judged({1.0}, {1.0}, criteria); });
  };
  EXPECT_HOLDS(refused({.max_abs = -1.0}), "the limit for max-abs is -1 (");
  EXPECT_HOLDS(refused({.max_rel = std::nan("")}), "the limit for max-rel is nan");
  EXPECT_HOLDS(refused({.rms = -1.0}), "the limit for rms");
  EXPECT_HOLDS(refused({.eps_b = -1.0}), "the limit for eps-b");
  EXPECT_HOLDS(refused({.quantiles = {{0.0, 1.0}}}), "the share of a quantile is 0 (");
  EXPECT_HOLDS(refused({.quantiles = {{1.5, 1.0}}}), "the share of a quantile is 1.5");
  EXPECT_HOLDS(refused({.quantiles = {{0.5, -1.0}}}), "the limit for quantile 0.5 is -1");
  EXPECT_HOLDS(complaint([] { (void)judge(truth_with({1.0}), std::vector<double>{}, {}); }),
               "has 1 row, but there are 0 values");
  EXPECT_HOLDS(complaint([] { (void)judge(truth_with({1.0}), std::vector<Measured>{}, {}); }), "has no row to check");
}

TEST(Criteria, TellTheWorstRowsFirst) {
  const Report report = judged({0.5, 0.25, 0.5, 0.5}, {0.625, 0.5, 0.5, std::nan("")}, {.max_rel = 0.1, .worst = 3});
  EXPECT_EQ(report.worst_by, Measure::kRelative);
  ASSERT_EQ(report.worst.size(), 3U);  // and no row without error
  EXPECT_EQ(report.worst[0].receiver, "4");
  EXPECT_EQ(report.worst[1].receiver, "2");
  EXPECT_EQ(report.worst[1].relative, 1.0);
  EXPECT_EQ(report.worst[2].receiver, "1");
  EXPECT_EQ(judged({0.5, 0.25}, {0.625, 0.5}, {.worst = 1}).worst.size(), 1U);
}

// --- Histogram ---

TEST(ErrorHistogram, CountsEveryErrorOnce) {
  const Report report = judged(std::vector<double>(6, 0.0), {0.0, 1e-3, 0.002, 0.01, 0.0100001, 5.0});
  const Histogram h = histogram(report);
  EXPECT_EQ(h.exact, 1U);
  ASSERT_EQ(h.bins.size(), 5U);
  const std::vector<std::size_t> counts = {h.bins[0].count, h.bins[1].count, h.bins[2].count, h.bins[3].count,
                                           h.bins[4].count};
  EXPECT_EQ(counts, (std::vector<std::size_t>{1, 2, 1, 0, 1}));  // up to 1e-3, 1e-2, 1e-1, 1, 10
  EXPECT_DOUBLE_EQ(h.bins[1].high, 1e-2);
}

TEST(CheckStatistics, DoNotLoseSmallErrorsToUnderflow) {
  EXPECT_DOUBLE_EQ(judged({0.0, 0.0}, {3e-200, 4e-200}).overall.absolute.rms, std::sqrt(12.5) * 1e-200);
}

TEST(Criteria, NoteRowsThatAreNotCertified) {
  Truth truth = truth_with({0.5});
  truth.rows[0].status = Status::kNotCertified;
  truth.rows[0].lower = 0.0;
  truth.rows[0].upper = 1.0;
  const Report report = judge(truth, std::vector{0.75}, {.max_abs = 0.0});
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.not_certified, 1U);
}

TEST(Criteria, WithARelativeFloorForgiveSmallTruths) {
  EXPECT_FALSE(judged({0.0, 1e-9}, {1e-6, 1e-6}, {.max_rel = 1e-3}).passed());
  EXPECT_TRUE(judged({0.0, 1e-9}, {1e-6, 1e-6}, {.max_rel = 1e-3, .relative_floor = 1e-3}).passed());
}

TEST(CheckStatistics, AreOfEverySource) {
  const Report report = judge(truth_of_two({0.5, 0.5}, {0.25, 0.25}), std::vector{0.5, 0.5, 0.5, 0.25}, {});
  EXPECT_EQ(report.sources, (std::vector<std::string>{"s", "t"}));
  EXPECT_EQ(report.by_source[0].absolute.max, 0.0);
  EXPECT_EQ(report.by_source[1].absolute.max, 0.25);
  EXPECT_EQ(report.by_source[1].rows, 2U);
}

TEST(ErrorHistogram, GathersWhatIsFarBelowInItsFirstBin) {
  const Histogram h = histogram(judged({0.0, 0.0, 0.0}, {5e-324, 1e-200, 1.0}), 1, 10);
  ASSERT_EQ(h.bins.size(), 10U);
  EXPECT_EQ(h.bins.front().count, 2U);
  EXPECT_EQ(h.bins.back().count, 1U);
  EXPECT_TRUE(histogram(judged({0.5}, {0.5})).bins.empty());
  EXPECT_EQ(histogram(judged({0.0}, {1.7e308})).bins.size(), 1U);
}

}  // namespace
}  // namespace exactff::check
