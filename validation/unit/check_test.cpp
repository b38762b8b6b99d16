#include "exactff/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/complaint.h"
#include "support/holds.h"
#include "support/program.h"

namespace exactff::check {
namespace {

using validation::complaint;
using validation::holds;
using validation::TemporaryDirectory;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

#define EXPECT_HOLDS(text, part) EXPECT_TRUE(holds(text, part)) << "\"" << (part) << "\" is not in:\n" << (text)

Truth truth_of(const std::string& text, const std::string& column = "exact") {
  const TemporaryDirectory directory;
  return read_truth(directory.write("truth.csv", text), column);
}

Candidate candidate_of(const std::string& text, const CandidateColumns& columns = {}, MatchBy by = MatchBy::kReceiver) {
  const TemporaryDirectory directory;
  return read_candidate(directory.write("mine.csv", text), columns, by);
}

TruthRow row_of(const std::string& receiver, double value, std::uint32_t source = 0) {
  TruthRow row;
  row.receiver = receiver;
  row.source = source;
  row.value = row.lower = row.upper = value;
  return row;
}

// Receivers 1, 2, ... with these values of one source.
Truth truth_with(const std::vector<double>& values) {
  Truth truth;
  truth.file = "truth.csv";
  truth.column = "exact";
  truth.sources = {"light"};
  truth.faces = {""};
  for (const double value : values) truth.rows.push_back(row_of(std::to_string(truth.rows.size() + 1), value));
  return truth;
}

// Sources s and t of receivers 1, 2, ...
Truth truth_of_two(const std::vector<double>& s, const std::vector<double>& t) {
  Truth truth = truth_with({});
  truth.sources = {"s", "t"};
  for (std::size_t i = 0; i < s.size(); ++i) {
    truth.rows.push_back(row_of(std::to_string(i + 1), s[i], 0));
    truth.rows.push_back(row_of(std::to_string(i + 1), t[i], 1));
  }
  return truth;
}

Report judged(const std::vector<double>& truth, const std::vector<double>& values, const Criteria& criteria = {}) {
  return judge(truth_with(truth), values, criteria);
}

const Verdict& verdict_on(const Report& report, const std::string& criterion, const std::string& source = {}) {
  for (const Verdict& verdict : report.verdicts) {
    if (verdict.criterion == criterion && verdict.source == source) return verdict;
  }
  throw std::runtime_error("there is no verdict on " + criterion);
}

// --- Reading the truth ---

TEST(TruthFile, TellsRowsSourcesAndFaces) {
  const Truth truth = truth_of(
      "# exactff 0.1.0 truth\r\n# scene: room.obj\r\n"
      "receiver,on,x,y,z,nx,ny,nz,source,exact,lower,upper,radiosity_r,radiosity_g,radiosity_b,largest_rho_b,status\r\n"
      "\"1,1\",floor:2,1,2,3,0,0,2,light,0.25,0.2,0.3,1,2,3,12,certified\r\n"
      "\"1,1\",floor:2,1,2,3,0,0,2,lamp,0,0,0,0,0,0,7,zero\r\n"
      "p,,1,2,3,0,1,0,light,0,0,5e-324,0,0,0,12,underflow\r\n");
  EXPECT_EQ(truth.header, (std::vector<std::string>{"exactff 0.1.0 truth", "scene: room.obj"}));
  EXPECT_EQ(truth.sources, (std::vector<std::string>{"light", "lamp"}));
  ASSERT_EQ(truth.rows.size(), 3U);
  const TruthRow& first = truth.rows.front();
  EXPECT_EQ(first.receiver, "r1c1");  // "1,1" in files of older versions
  EXPECT_EQ(truth.face_of(first), "floor:2");
  EXPECT_EQ(truth.face_of(truth.rows[2]), "");
  EXPECT_EQ(first.point, (Vec3{1, 2, 3}));
  EXPECT_EQ(first.normal, (Vec3{0, 0, 2}));
  EXPECT_EQ(first.line, 4U);
  EXPECT_EQ(first.value, 0.25);
  EXPECT_EQ(first.lower, 0.2);
  EXPECT_EQ(first.upper, 0.3);
  EXPECT_EQ(first.largest_rho_b, 12.0);
  EXPECT_EQ(truth.source_of(truth.rows[1]), "lamp");
  EXPECT_EQ(truth.rows[1].status, Status::kZero);
  EXPECT_EQ(truth.rows[2].status, Status::kUnderflow);
}

TEST(TruthFile, MayHoldReceiversAndValuesOnly) {
  const Truth truth = truth_of("id,exact\n7,0.5\n");
  EXPECT_FALSE(truth.has_points);
  EXPECT_FALSE(truth.has_normals);
  EXPECT_EQ(truth.sources, std::vector<std::string>{""});
  EXPECT_EQ(truth.rows.front().lower, 0.5);
  EXPECT_FALSE(truth.rows.front().largest_rho_b.has_value());
}

TEST(TruthFile, LendsAnotherColumnWithoutTheBoundsOfTheFormFactor) {
  const std::string text =
      "receiver,source,exact,lower,upper,unoccluded,radiosity_r,radiosity_g,radiosity_b\na,s,.25,.2,.3,.5,1,2,.5\n";
  const Truth unoccluded = truth_of(text, "unoccluded");
  EXPECT_EQ(unoccluded.rows.front().value, 0.5);
  EXPECT_EQ(unoccluded.rows.front().upper, 0.5);
  EXPECT_EQ(unoccluded.rows.front().largest_rho_b, 8.0);  // 2 / 0.25, whatever the column
  const Truth radiosity = truth_of(text, "radiosity_g");
  EXPECT_EQ(radiosity.rows.front().value, 2.0);
  EXPECT_EQ(radiosity.rows.front().largest_rho_b, 1.0);
}

TEST(TruthFile, FindsRhoBOfZerosFromTheirFaceElseFromTheirSource) {
  const Truth truth = truth_of(
      "receiver,on,source,exact,radiosity_r,radiosity_g,radiosity_b\n"
      "a,floor,s,0.5,1,2,0\nb,floor,s,0,0,0,0\nc,wall,s,0.25,2,2,2\nd,wall,s,0,0,0,0\ne,roof,s,0,0,0,0\n"
      "f,floor,t,0,0,0,0\n");
  std::vector<std::optional<double>> found;
  for (const TruthRow& row : truth.rows) found.push_back(row.largest_rho_b);
  EXPECT_EQ(found, (std::vector<std::optional<double>>{4.0, 4.0, 8.0, 8.0, 8.0, std::nullopt}));
}

TEST(TruthFile, IsRefusedWithEveryProblemAndItsLine) {
  const std::string what = complaint([] {
    (void)truth_of(
        "receiver,source,exact,lower,upper,status\n"
        "a,s,0.5,0.6,0.7,certified\nb,s,nan,0,1,certified\n,s,0.5,0,1,certified\nc,s,0.5,0,1,sure\nd,s,0.5\n"
        "a,s,0.5,0,1,certified\n");
  });
  EXPECT_HOLDS(what, "truth.csv:2: the value is not within its bounds (");
  EXPECT_HOLDS(what, "truth.csv:3: 'nan' is not a finite number in column 'exact' (");
  EXPECT_HOLDS(what, "truth.csv:4: the receiver has no id (");
  EXPECT_HOLDS(what, "truth.csv:5: unknown status 'sure' (");
  EXPECT_HOLDS(what, "truth.csv:6: 3 fields where there are 6 columns (");
  EXPECT_HOLDS(what, "truth.csv:7: receiver 'a' has a second row of source 's' (the first is line 2) (");
}

TEST(TruthFile, IsRefusedWithoutColumnsOrRows) {
  EXPECT_HOLDS(complaint([] { (void)truth_of("# nothing\n"); }), "the file has no column names");
  EXPECT_HOLDS(complaint([] { (void)truth_of("receiver,exact\n"); }), "the file has no rows");
  const std::string what = complaint([] { (void)truth_of("x,y\n1,2\n"); });
  EXPECT_HOLDS(what, "there is no column 'receiver' or 'id' among 'x,y'");
  EXPECT_HOLDS(what, "there is no column 'exact'");
  EXPECT_HOLDS(complaint([] { (void)truth_of("receiver,exact,exact\na,1,1\n"); }), "column 'exact' occurs twice");
  EXPECT_HOLDS(complaint([] { (void)truth_of("receiver;exact\na;1\n"); }), "not separated by commas");
  EXPECT_HOLDS(complaint([] { (void)truth_of("\"receiver,exact\n"); }), "a quotation mark is not closed");
}

// --- Reading the candidate ---

TEST(CandidateFile, NamesItsColumnsByDefaultOrByRequest) {
  EXPECT_EQ(candidate_of("receiver,exact,approximate\na,1,2\n").rows.front().value, 2.0);
  EXPECT_EQ(candidate_of("id,value,exact\na,1,2\n").rows.front().value, 1.0);
  const CandidateColumns columns{.value = "ff", .receiver = "point", .source = "lamp"};
  const Candidate candidate = candidate_of("point,lamp,ff,value\na,l,3,4\n", columns);
  EXPECT_EQ(candidate.rows.front().value, 3.0);
  EXPECT_EQ(candidate.rows.front().receiver, "a");
  EXPECT_EQ(candidate.sources, std::vector<std::string>{"l"});
}

TEST(CandidateFile, MayHoldValuesThatAreNoNumbers) {
  const Candidate candidate =
      candidate_of("receiver,value\na,nan\nb,-NaN\nc,inf\nd,-Infinity\ne,1e999\nf,-1e999\ng,1.#IND\n");
  ASSERT_EQ(candidate.rows.size(), 7U);
  EXPECT_TRUE(std::isnan(candidate.rows[0].value));
  EXPECT_TRUE(std::isnan(candidate.rows[1].value));
  EXPECT_EQ(candidate.rows[2].value, kInfinity);
  EXPECT_EQ(candidate.rows[3].value, -kInfinity);
  EXPECT_EQ(candidate.rows[4].value, kInfinity);
  EXPECT_EQ(candidate.rows[5].value, -kInfinity);
  EXPECT_TRUE(std::isnan(candidate.rows[6].value));
}

TEST(CandidateFile, IsRefusedWithEveryProblemAndItsLine) {
  const std::string what = complaint([] { (void)candidate_of("receiver,value\na,\nb,x\n,1\nc,1,2\nd,\"1\n"); });
  EXPECT_HOLDS(what, "mine.csv:2: column 'value' is empty (this column must contain numbers); write nan");
  EXPECT_HOLDS(what, "mine.csv:3: 'x' is not a number in column 'value' (");
  EXPECT_HOLDS(what, "mine.csv:4: the receiver has no id (");
  EXPECT_HOLDS(what, "mine.csv:5: 3 fields where there are 2 columns (");
  EXPECT_HOLDS(what, "mine.csv:6: a quotation mark is not closed in its line");
  EXPECT_HOLDS(complaint([] { (void)candidate_of("a,b\n1,2\n"); }),
               "there is no column 'value' or 'approximate' or 'exact' among 'a,b'");
  EXPECT_HOLDS(complaint([] { (void)candidate_of("receiver,value\na,1\n", {.value = "ff"}); }), "no column 'ff'");
  EXPECT_HOLDS(complaint([] { (void)candidate_of("receiver,value\na,1\n", {.source = "s"}); }), "no column 's'");
  EXPECT_HOLDS(complaint([] { (void)candidate_of("value\n1\n", {}, MatchBy::kPosition); }), "no column 'x' among");
}

// --- Matching ---

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

TEST(Match, AllowsMissingRowsOnRequestButNotNone) {
  const Truth truth = truth_of("receiver,exact\na,.1\nb,.2\n");
  EXPECT_EQ(matched(truth, candidate_of("receiver,value\nb,2\n"), {.partial = true}), std::vector<double>{2});
  EXPECT_HOLDS(complaint([&] { (void)match(truth, candidate_of("receiver,value\nc,2\n"), {.partial = true}); }),
               "the truth has no receiver 'c'");
  EXPECT_HOLDS(complaint([&] { (void)match(truth, candidate_of("receiver,value\n"), {.partial = true}); }),
               "has no rows");
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
               "mine.csv:2: the truth has no receiver within 0.0049 of source 's' (");
}

TEST(MatchByPosition, RefusesAChoice) {
  const std::string what =
      complaint([] { (void)matched_by_position("x,y,z,source,value\n0.25,0,0,s,1\n0,0,0,t,2\n", 0.75); });
  EXPECT_HOLDS(what,
               "mine.csv:2: 3 receivers of the truth match: 'a' at a distance of 0.25 and 'c' at a distance of 0.25, "
               "and more (it is not clear which one the value belongs to); use a smaller --tolerance");
  EXPECT_FALSE(holds(what, "mine.csv:3"));
}

TEST(MatchByPosition, RefusesTwoValuesForOneRow) {
  EXPECT_HOLDS(complaint([] { (void)matched_by_position("x,y,z,source,value\n1,0,0,s,1\n1.1,0,0,s,2\n", 0.2); }),
               "receiver 'b' of source 's' already has a value (line 2)");
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

TEST(MatchByPosition, NeedsCoordinatesOfTheTruth) {
  EXPECT_HOLDS(complaint([] {
                 (void)match(truth_of("receiver,exact\na,1\n"),
                             candidate_of("x,y,z,value\n0,0,0,1\n", {}, MatchBy::kPosition),
                             {.by = MatchBy::kPosition});
               }),
               "has no columns x, y and z");
}

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

TEST(CheckStatistics, DoNotLoseSmallErrorsToUnderflow) {
  EXPECT_DOUBLE_EQ(judged({0.0, 0.0}, {3e-200, 4e-200}).overall.absolute.rms, std::sqrt(12.5) * 1e-200);
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

TEST(CheckStatistics, AreOfEverySource) {
  const Report report = judge(truth_of_two({0.5, 0.5}, {0.25, 0.25}), std::vector{0.5, 0.5, 0.5, 0.25}, {});
  EXPECT_EQ(report.sources, (std::vector<std::string>{"s", "t"}));
  EXPECT_EQ(report.by_source[0].absolute.max, 0.0);
  EXPECT_EQ(report.by_source[1].absolute.max, 0.25);
  EXPECT_EQ(report.by_source[1].rows, 2U);
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

TEST(Criteria, WithARelativeFloorForgiveSmallTruths) {
  EXPECT_FALSE(judged({0.0, 1e-9}, {1e-6, 1e-6}, {.max_rel = 1e-3}).passed());
  EXPECT_TRUE(judged({0.0, 1e-9}, {1e-6, 1e-6}, {.max_rel = 1e-3, .relative_floor = 1e-3}).passed());
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

TEST(Criteria, NoteRowsThatAreNotCertified) {
  Truth truth = truth_with({0.5});
  truth.rows[0].status = Status::kNotCertified;
  truth.rows[0].lower = 0.0;
  truth.rows[0].upper = 1.0;
  const Report report = judge(truth, std::vector{0.75}, {.max_abs = 0.0});
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.not_certified, 1U);
}

// --- Ratchet ---

struct Ratchet {
  TemporaryDirectory directory;
  std::filesystem::path file;

  explicit Ratchet(const Report& report) : file(directory.write("baseline.json", baseline_text(report))) {}
  Report held(Report report, double slack = kDefaultSlack) const {
    hold_against_baseline(report, file, slack);
    return report;
  }
};

TEST(Baseline, IsKeptByTheSameErrors) {
  const Report report = judged({0.5, 0.25}, {0.625, 0.25});
  const Report held = Ratchet(report).held(report);
  EXPECT_TRUE(held.passed());
  EXPECT_EQ(held.verdicts.size(), 1U + 4U);  // rho B is not known: no eps-b
  EXPECT_TRUE(held.improvements.empty());
}

TEST(Baseline, IsBrokenByLargerErrorsAndTellsWhich) {
  const Ratchet ratchet(judged({0.5, 0.25}, {0.625, 0.25}));
  const Report held = ratchet.held(judged({0.5, 0.25}, {0.625, 0.26}));  // the largest absolute error is the same
  EXPECT_FALSE(held.passed());
  EXPECT_TRUE(verdict_on(held, "baseline max-abs").passed);
  EXPECT_FALSE(verdict_on(held, "baseline rms").passed);
  EXPECT_TRUE(verdict_on(held, "baseline quantile 0.99").passed);
}

TEST(Baseline, TellsWhatImproved) {
  const Ratchet ratchet(judged({0.5, 0.25}, {0.625, 0.25}));
  const Report held = ratchet.held(judged({0.5, 0.25}, {0.5625, 0.25}));
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

TEST(Baseline, WithInfiniteErrorsImprovesToFiniteOnes) {
  const Ratchet ratchet(judged({0.0}, {0.125}));
  EXPECT_TRUE(ratchet.held(judged({0.0}, {0.125})).passed());
  EXPECT_EQ(ratchet.held(judged({0.0}, {0.0})).improvements[1].recorded, kInfinity);
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

TEST(ErrorHistogram, GathersWhatIsFarBelowInItsFirstBin) {
  const Histogram h = histogram(judged({0.0, 0.0, 0.0}, {5e-324, 1e-200, 1.0}), 1, 10);
  ASSERT_EQ(h.bins.size(), 10U);
  EXPECT_EQ(h.bins.front().count, 2U);
  EXPECT_EQ(h.bins.back().count, 1U);
  EXPECT_TRUE(histogram(judged({0.5}, {0.5})).bins.empty());
  EXPECT_EQ(histogram(judged({0.0}, {1.7e308})).bins.size(), 1U);
}

TEST(ErrorHistogram, IsAScriptUnlessNothingIsToBeSeen) {
  const std::string script = histogram_script(judged({0.0, 0.0}, {0.5, 0.0}, {.max_abs = 0.25}));
  EXPECT_HOLDS(script, "set arrow from 0.25, graph 0");
  EXPECT_HOLDS(script, "2 rows, 1 of them without error");
  EXPECT_EQ(histogram_script(judged({0.5}, {0.5})), "");
}

}  // namespace
}  // namespace exactff::check
