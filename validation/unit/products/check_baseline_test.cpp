// The ratchet of a check: errors held against a baseline of earlier ones.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "check/baseline.h"
#include "support/complaint.h"
#include "support/program.h"
#include "unit/products/check_support.h"

namespace exactff::check {
namespace {

using validation::complaint;
using validation::TemporaryDirectory;

struct Held : Report {
  std::vector<Improvement> improvements;
};

struct Ratchet {
  TemporaryDirectory directory;
  std::filesystem::path file;

  explicit Ratchet(const Report& report) : file(directory.write("baseline.json", baseline_text(report))) {}
  Held held(Report report, double slack = kDefaultSlack) const {
    std::vector<Improvement> improvements = hold_against_baseline(report, file, slack);
    return {std::move(report), std::move(improvements)};
  }
};

TEST(Baseline, IsKeptByTheSameErrors) {
  const Report report = judged({0.5, 0.25}, {0.625, 0.25});
  const Held held = Ratchet(report).held(report);
  EXPECT_TRUE(held.passed());
  EXPECT_EQ(held.verdicts.size(), 1U + 4U);  // rho B is not known: no eps-b
  EXPECT_TRUE(held.improvements.empty());
}

TEST(Baseline, IsBrokenByLargerErrorsAndTellsWhich) {
  const Ratchet ratchet(judged({0.5, 0.25}, {0.625, 0.25}));
  const Held held = ratchet.held(judged({0.5, 0.25}, {0.625, 0.26}));  // the largest absolute error is the same
  EXPECT_FALSE(held.passed());
  EXPECT_TRUE(verdict_on(held, "baseline max-abs").passed);
  EXPECT_FALSE(verdict_on(held, "baseline rms").passed);
  EXPECT_TRUE(verdict_on(held, "baseline quantile 0.99").passed);
}

TEST(Baseline, TellsWhatImproved) {
  const Ratchet ratchet(judged({0.5, 0.25}, {0.625, 0.25}));
  const Held held = ratchet.held(judged({0.5, 0.25}, {0.5625, 0.25}));
  EXPECT_TRUE(held.passed());
  ASSERT_EQ(held.improvements.size(), 4U);
  EXPECT_EQ(held.improvements.front().criterion, "baseline max-abs");
  EXPECT_EQ(held.improvements.front().recorded, 0.125);
  EXPECT_EQ(held.improvements.front().now, 0.0625);
}

TEST(Baseline, AllowsForSlackAndForRoundings) {
  const Ratchet ratchet(judged({0.5, 0.25}, {0.625, 0.25}));
  const Report worse = judged({0.5, 0.25}, {0.625 + 0.001, 0.25});
  EXPECT_FALSE(ratchet.held(worse).passed());
  EXPECT_FALSE(ratchet.held(worse, 0.007).passed());
  EXPECT_TRUE(ratchet.held(worse, 0.009).passed());
  EXPECT_TRUE(ratchet.held(judged({0.5, 0.25}, {std::nextafter(0.625, 1.0), 0.25}), 0.0).passed());
  const Ratchet exact(judged({0.5, 0.25}, {0.5, 0.25}));
  EXPECT_TRUE(exact.held(judged({0.5, 0.25}, {std::nextafter(0.5, 1.0), 0.25})).passed());
  EXPECT_FALSE(exact.held(judged({0.5, 0.25}, {0.5 + 1e-14, 0.25})).passed());
}

TEST(Baseline, IsOfTheseRowsInAnyOrderAndNoOthers) {
  const Ratchet ratchet(judged({0.5, 0.25}, {0.5, 0.25}));
  Truth turned = truth_with({0.5, 0.25});
  std::swap(turned.rows[0], turned.rows[1]);
  EXPECT_TRUE(ratchet.held(judge(turned, std::vector{0.25, 0.5}, {})).passed());
  const auto refused = [&](const Report& report) { return complaint([&] { (void)ratchet.held(report); }); };
  const std::string why = "was recorded with different rows, true values or relative floor";
  EXPECT_HOLDS(refused(judged({0.5, std::nextafter(0.25, 1.0)}, {0.5, 0.25})), why);
  EXPECT_HOLDS(refused(judged({0.5}, {0.5})), why);
  EXPECT_HOLDS(refused(judged({0.25, 0.5}, {0.25, 0.5})), why);
  EXPECT_HOLDS(refused(judged({0.5, 0.25}, {0.5, 0.25}, {.relative_floor = 0.1})), why);
}

TEST(Baseline, IsRefusedIfItIsNone) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text) {
    Report report = judged({0.5}, {0.5});
    const auto file = directory.write("b.json", text);
    return complaint([&] { hold_against_baseline(report, file); });
  };
  for (const char* text :
       {"", "{", "[]", "{}", "3", "{\"baseline\": 2}", "{\"baseline\": 1}", "{\"baseline\": 1, \"truth\": 3}"}) {
    EXPECT_HOLDS(refused(text), "is not a baseline that this program can read") << text;
  }
  Report report = judged({0.5}, {0.5});
  EXPECT_HOLDS(complaint([&] { hold_against_baseline(report, directory.path() / "none.json"); }),
               "this baseline file does not exist");
  const auto file = directory.write("b.json", baseline_text(report));
  EXPECT_HOLDS(complaint([&] { hold_against_baseline(report, file, -1.0); }), "the slack for the baseline is -1");
}

TEST(Baseline, OfEverySourceIsKeptByEverySource) {
  const Truth truth = truth_of_two({0.5}, {0.5});
  const Ratchet ratchet(judge(truth, std::vector{0.75, 0.5}, {}));
  const std::vector<double> swapped{0.5, 0.75};
  EXPECT_TRUE(ratchet.held(judge(truth, swapped, {})).passed());
  const Held held = ratchet.held(judge(truth, swapped, {.per_source = true}));
  EXPECT_FALSE(verdict_on(held, "baseline max-abs", "t").passed);
  EXPECT_TRUE(verdict_on(held, "baseline max-abs", "s").passed);
  EXPECT_EQ(held.improvements.front().source, "s");
}

TEST(Baseline, WithInfiniteErrorsImprovesToFiniteOnes) {
  const Ratchet ratchet(judged({0.0}, {0.125}));
  EXPECT_TRUE(ratchet.held(judged({0.0}, {0.125})).passed());
  EXPECT_EQ(ratchet.held(judged({0.0}, {0.0})).improvements[1].recorded, kInfinity);
}

}  // namespace
}  // namespace exactff::check
