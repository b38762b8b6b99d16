// What a check finds: errors, their statistics, verdicts, matches, baselines, and what machines read.
#include <nlohmann/json.hpp>

#include "check/report.h"
#include "page/gnuplot.h"
#include "support/test.h"
#include "unit/products/check_support.h"

namespace exactff::check {
namespace {

TEST(Difference, CountsDoubles) {
  EXPECT_EQ(difference(1.0, 1.0).ulps, 0.0);
  EXPECT_EQ(difference(std::nextafter(1.0, 2.0), 1.0).ulps, 1.0);
  EXPECT_EQ(difference(std::nextafter(1.0, 0.0), 1.0).ulps, 1.0);
  EXPECT_EQ(difference(-5e-324, 5e-324).ulps, 2.0);
  EXPECT_EQ(difference(-0.0, 0.0).ulps, 0.0);
  EXPECT_EQ(difference(kInfinity, 0.5).ulps, kInfinity);
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

// --- Which value of a candidate belongs to which row of the truth: by names, or by position ---

std::vector<double> matched(const Truth& truth, const Candidate& candidate, const MatchOptions& options = {}) {
  std::vector<double> values;
  for (const Measured& one : match(truth, candidate, options)) {
    EXPECT_TRUE(values.empty() || one.row > 0);
    values.push_back(one.value);
  }
  return values;
}

TEST(Match, FindsRowsByReceiverAndSourceInAnyOrder) {
  const Truth truth = truth_of("receiver,source,exact\na,s,.1\na,t,.2\nb,s,.3\nb,t,.4\n");
  const Candidate candidate = candidate_of("source,value,receiver\nt,4,b\ns,1,a\ns,3,b\nt,2,a\n");
  EXPECT_EQ(matched(truth, candidate), (std::vector<double>{1, 2, 3, 4}));
  const auto lines = match(truth, candidate);
  EXPECT_EQ(lines.back().line, 2U);
}

TEST(Match, NeedsNoSourceWhereTheTruthHasOne) {
  const Candidate plain = candidate_of("receiver,value\na,1\n");
  EXPECT_EQ(matched(truth_of("receiver,source,exact\na,s,.1\n"), plain), std::vector<double>{1});
  EXPECT_EQ(matched(truth_of("receiver,exact\na,.1\n"), candidate_of("receiver,source,value\na,s,1\n")),
            std::vector<double>{1});
  const Truth two = truth_of("receiver,source,exact\na,s,.1\na,t,.2\n");
  EXPECT_HOLDS(complaint([&] { (void)match(two, plain); }),
               "has no column that names the source (the truth has 2: s and t); add a column named source");
}

TEST(Match, RefusesWhatIsMissingDoubledOrUnknown) {
  const Truth truth = truth_of("receiver,source,exact\na,s,.1\nb,s,.2\nc,s,.3\n");
  const Candidate candidate = candidate_of("receiver,source,value\na,s,1\na,s,1\nd,s,1\nb,u,1\n");
  const std::string what = complaint([&] { (void)match(truth, candidate); });
  EXPECT_HOLDS(what,
               "mine.csv: no value for 2 of 3 rows of the truth: receiver 'b' of source 's' and 'c' of source 's' (");
  EXPECT_HOLDS(what, "add them, or use --partial");
  EXPECT_HOLDS(what, "mine.csv:3: receiver 'a' of source 's' already has a value (line 2) (");
  EXPECT_HOLDS(what, "mine.csv:4: the truth has no receiver 'd' of source 's' (");
  EXPECT_HOLDS(what, "mine.csv:5: the truth has no source 'u' (its sources are s)");
}

constexpr const char* kPlaces =
    "receiver,x,y,z,nx,ny,nz,source,exact\n"
    "a,0,0,0,0,0,1,s,.1\nb,1,0,0,0,0,1,s,.2\nc,0,0,0,5,0,0,s,.3\na,0,0,0,0,0,1,t,.4\n";

std::vector<double> matched_by_position(const std::string& candidate, double tolerance, bool partial = true) {
  return matched(truth_of(kPlaces), candidate_of(candidate, {}, MatchBy::kPosition),
                 {.by = MatchBy::kPosition, .tolerance = tolerance, .partial = partial});
}

TEST(MatchByPosition, TellsReceiversInOnePlaceByTheirNormalsOfAnyLength) {
  EXPECT_EQ(matched_by_position("x,y,z,nx,ny,nz,source,value\n"
                                "0,0,0,1,0,0,s,3\n1,0,0,0,0,1e-200,s,2\n0,-0,0,0,0,7,t,4\n0,0,0,0,0,1,s,1\n",
                                0.0, false),
            (std::vector<double>{1, 2, 3, 4}));
}

TEST(MatchByPosition, TakesTheToleranceAsADistance) {
  const std::string near = "x,y,z,nx,ny,nz,source,value\n1,0.003,0.004,0,0,1,s,2\n";
  EXPECT_EQ(matched_by_position(near, 0.0051), std::vector<double>{2});
  EXPECT_HOLDS(complaint([&] { (void)matched_by_position(near, 0.0049); }),
               "mine.csv:2: the truth has no receiver within 0.0049 of (1, 0.003, 0.004) of source 's' (");
}

TEST(MatchByPosition, RefusesAChoice) {
  const std::string what =
      complaint([] { (void)matched_by_position("x,y,z,source,value\n0.25,0,0,s,1\n0,0,0,t,2\n", 0.75); });
  EXPECT_HOLDS(what,
               "mine.csv:2: 3 receivers of the truth match: 'a' at a distance of 0.25 and 'c' at a distance of 0.25, "
               "and more (it is not clear which one the value belongs to); use a smaller --tolerance");
  EXPECT_FALSE(holds(what, "mine.csv:3"));
}

TEST(MatchByPosition, WorksAtBothEndsOfTheDoubles) {
  const Truth truth = truth_of("receiver,x,y,z,exact\na,1e300,0,0,.1\nb,-1e300,0,0,.2\nc,1e-320,0,0,.3\nd,0,0,0,.4\n");
  const Candidate candidate =
      candidate_of("x,y,z,value\n0,0,0,4\n1e-320,0,0,3\n-1e300,0,0,2\n1e300,0,0,1\n", {}, MatchBy::kPosition);
  EXPECT_EQ(matched(truth, candidate, {.by = MatchBy::kPosition}), (std::vector<double>{1, 2, 3, 4}));
}

TEST(MatchByPosition, FindsWhatASearchOfAllFinds) {
  std::string truth = "receiver,x,y,z,exact\n", mine = "x,y,z,value\n";
  for (int i = 0; i < 400; ++i) {
    const std::string place = std::to_string(i % 20) + ',' + std::to_string(i / 20 % 4) + ',' + std::to_string(i / 80);
    truth += std::to_string(i) + ',' + place + ",0.5\n";
    mine += place + ',' + std::to_string(i) + '\n';
  }
  const Candidate candidate = candidate_of(mine, {}, MatchBy::kPosition);
  for (const Measured& one : match(truth_of(truth), candidate, {.by = MatchBy::kPosition, .tolerance = 0.9})) {
    EXPECT_EQ(one.value, one.row);
  }
}

// --- The ratchet of a check: errors held against a baseline of earlier ones ---

struct Ratchet {
  TemporaryDirectory directory;
  std::filesystem::path file;

  explicit Ratchet(const Report& report) : file(directory.write("baseline.json", baseline_text(report))) {}
  Report held(Report report, double slack = kDefaultSlack) const {
    hold_against_baseline(report, file, slack);
    return report;
  }
};

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

TEST(Baseline, OfEverySourceIsKeptByEverySource) {
  const Truth truth = truth_of_two({0.5}, {0.5});
  const Ratchet ratchet(judge(truth, std::vector{0.75, 0.5}, {}));
  const std::vector<double> swapped{0.5, 0.75};
  EXPECT_TRUE(ratchet.held(judge(truth, swapped, {})).passed());
  const Report held = ratchet.held(judge(truth, swapped, {.per_source = true}));
  EXPECT_FALSE(verdict_on(held, "baseline max-abs", "t").passed);
  EXPECT_TRUE(verdict_on(held, "baseline max-abs", "s").passed);
  EXPECT_EQ(held.improvements.front().source, "s");
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

// --- The machine-readable output of a check, with values and names that may break a parser ---

// Receivers with awkward names; the second value has an error of 0.25, 1 relative.
Report awkward_report(const Criteria& criteria, double first = 0.5) {
  Truth truth;
  truth.file = "a,b:100%.csv";
  truth.column = "exact";
  truth.sources = {"l<&>\"amp"};
  truth.faces = {""};
  truth.rows.resize(2);
  truth.rows[0].receiver = "::error::x";
  truth.rows[0].value = truth.rows[0].lower = truth.rows[0].upper = 0.5;
  truth.rows[1].receiver = "a\x01\xFF\n]]>";
  truth.rows[1].value = truth.rows[1].lower = truth.rows[1].upper = 0.25;
  const std::vector<Measured> values = {{0, 7, first}, {1, 9, 0.5}};
  return judge(truth, values, criteria, "c,d:50%.csv");
}

TEST(JUnit, EscapesNames) {
  const std::string xml = junit_xml(awkward_report({.max_abs = 0.125}));
  EXPECT_HOLDS(
      xml,
      "<failure message=\"max-abs: 0.25 is above the limit 0.125, worst at receiver 'a\\x01\\xff\\x0a]]&gt;', source "
      "'l&lt;&amp;&gt;&quot;amp'\" type=\"max-abs\">");
  EXPECT_HOLDS(xml,
               "worst rows by absolute error:\nreceiver 'a\\x01\\xff\\x0a]]&gt;', source 'l&lt;&amp;&gt;&quot;amp': "
               "exact 0.25, ");
  EXPECT_HOLDS(xml, ": exact 0.25, found 0.5, error 0.25, relative 1</failure>");
  EXPECT_FALSE(holds(xml, "\x01") || holds(xml, "\xFF"));
}

TEST(GitHubAnnotations, PointToTheWorstRowAndEscapeWhatEndsThem) {
  EXPECT_EQ(
      github_annotations(awkward_report({.max_abs = 0.125})),
      "::error file=c%2Cd%3A50%25.csv,line=9,title=exactff check%3A max-abs::max-abs: 0.25 is above the limit 0.125, "
      "worst at receiver 'a\\x01\\xff\\x0a]]>', source 'l<&>\"amp'%0Aexact 0.25, found 0.5, error 0.25, relative 1\n");
}

TEST(CheckJson, TellsEverythingAndSurvivesAnyName) {
  const auto json = nlohmann::json::parse(json_text(awkward_report({.max_abs = 0.125, .eps_b = {}}, std::nan(""))));
  EXPECT_EQ(json["passed"], false);
  EXPECT_EQ(json["truth"]["rows"], 2);
  EXPECT_EQ(json["verdicts"][0]["criterion"], "finite");
  EXPECT_EQ(json["verdicts"][1]["measured"], 0.25);
  EXPECT_EQ(json["verdicts"][1]["worst"]["line"], 9);
  EXPECT_EQ(json["overall"]["not_finite"], 1);
  EXPECT_EQ(json["overall"]["absolute"]["max"], 0.25);
  EXPECT_EQ(json["worst"][0]["value"], "nan");
  EXPECT_EQ(json["worst"][1]["receiver"], "a\x01\\xff\n]]>");
  EXPECT_TRUE(json["sources"].contains("l<&>\"amp"));
  EXPECT_EQ(json["histogram"]["bins"][0]["rows"], 1);
}

}  // namespace
}  // namespace exactff::check
