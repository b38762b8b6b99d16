// The files that a check reads: the truth, and the values held against it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "exactff/check.h"
#include "support/complaint.h"
#include "unit/products/check_support.h"

namespace exactff::check {
namespace {

using validation::complaint;

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
  EXPECT_HOLDS(complaint([] { (void)truth_of("receiver\texact\na\t1\n"); }), "the column names are separated by tabs");
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

// As spreadsheets write it where the comma is the decimal sign, with a byte order mark.
TEST(CandidateFile, MayHaveSemicolonsAndDecimalCommas) {
  const Candidate german = candidate_of(
      "\xEF\xBB\xBF"
      "receiver;source;value\r\na;\"l;1\";0,25\r\nb;m;1,5E-05\r\n");
  ASSERT_EQ(german.rows.size(), 2U);
  EXPECT_EQ(german.rows[0].value, 0.25);
  EXPECT_EQ(german.rows[1].value, 1.5e-5);
  EXPECT_EQ(german.sources, (std::vector<std::string>{"l;1", "m"}));
  EXPECT_EQ(candidate_of("receiver;value\na;0.25\n").rows.front().value, 0.25);
  EXPECT_EQ(truth_of("receiver;exact\na;0,5\n").rows.front().value, 0.5);
}

TEST(CandidateFile, HasOneDecimalSign) {
  EXPECT_HOLDS(complaint([] { (void)candidate_of("receiver;value\na;0,25\nb;0.5\n"); }),
               "mine.csv:3: '0.5' has a decimal point, and a number above it a decimal comma, in column 'value' (this "
               "column must contain numbers); write all numbers alike");
  EXPECT_HOLDS(complaint([] { (void)candidate_of("receiver;value\na;0.25\nb;1,234\n"); }),
               "mine.csv:3: '1,234' has a decimal comma in column 'value' (");
  EXPECT_HOLDS(complaint([] { (void)candidate_of("receiver;value\na;0;1\n"); }),
               "separate fields by semicolons, and quote fields that contain a semicolon");
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

TEST(TruthFile, FindsRhoBOfZerosFromTheirFaceElseFromTheirSource) {
  const Truth truth = truth_of(
      "receiver,on,source,exact,radiosity_r,radiosity_g,radiosity_b\n"
      "a,floor,s,0.5,1,2,0\nb,floor,s,0,0,0,0\nc,wall,s,0.25,2,2,2\nd,wall,s,0,0,0,0\ne,roof,s,0,0,0,0\n"
      "f,floor,t,0,0,0,0\n");
  std::vector<std::optional<double>> found;
  for (const TruthRow& row : truth.rows) found.push_back(row.largest_rho_b);
  EXPECT_EQ(found, (std::vector<std::optional<double>>{4.0, 4.0, 8.0, 8.0, 8.0, std::nullopt}));
}

}  // namespace
}  // namespace exactff::check
