// Which value of a candidate belongs to which row of the truth: by names, or by position.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "exactff/check.h"
#include "support/complaint.h"
#include "support/holds.h"
#include "unit/products/check_support.h"

namespace exactff::check {
namespace {

using validation::complaint;
using validation::holds;

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

TEST(MatchByPosition, RefusesTwoValuesForOneRow) {
  EXPECT_HOLDS(complaint([] { (void)matched_by_position("x,y,z,source,value\n1,0,0,s,1\n1.1,0,0,s,2\n", 0.2); }),
               "receiver 'b' of source 's' already has a value (line 2)");
}

TEST(MatchByPosition, NeedsCoordinatesOfTheTruth) {
  EXPECT_HOLDS(complaint([] {
                 (void)match(truth_of("receiver,exact\na,1\n"),
                             candidate_of("x,y,z,value\n0,0,0,1\n", {}, MatchBy::kPosition),
                             {.by = MatchBy::kPosition});
               }),
               "has no columns x, y and z");
}

}  // namespace
}  // namespace exactff::check
