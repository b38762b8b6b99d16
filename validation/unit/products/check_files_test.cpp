// The files that a check reads: the truth, and the values held against it.
#include <nlohmann/json.hpp>

#include "check/report.h"
#include "support/test.h"
#include "table/rows.h"
#include "text/phrases.h"
#include "unit/products/check_support.h"

namespace exactff::check {
namespace {

TEST(TruthFile, TellsRowsSourcesAndFaces) {
  const Truth truth = truth_of(
      "# by hand\r\n"
      "receiver,on,x,y,z,nx,ny,nz,source,exact,lower,upper,radiosity_r,radiosity_g,radiosity_b,largest_rho_b,status\r\n"
      "\"1,1\",floor:2,1,2,3,0,0,2,light,0.25,0.2,0.3,1,2,3,12,certified\r\n"
      "\"1,1\",floor:2,1,2,3,0,0,2,lamp,0,0,0,0,0,0,7,zero\r\n"
      "p,,1,2,3,0,1,0,light,0,0,5e-324,0,0,0,12,underflow\r\n");
  EXPECT_EQ(truth.sources, (std::vector<std::string>{"light", "lamp"}));
  ASSERT_EQ(truth.rows.size(), 3U);
  const TruthRow& first = truth.rows.front();
  EXPECT_EQ(first.receiver, "1,1");
  EXPECT_EQ(truth.face_of(first), "floor:2");
  EXPECT_EQ(truth.face_of(truth.rows[2]), "");
  EXPECT_EQ(first.point, (Vec3{1, 2, 3}));
  EXPECT_EQ(first.normal, (Vec3{0, 0, 2}));
  EXPECT_EQ(first.line, 3U);
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
  EXPECT_HOLDS(complaint([] { (void)truth_of("receiver\texact\na\t1\n"); }), "the column names are separated by tabs");
  EXPECT_HOLDS(complaint([] { (void)truth_of("\"receiver,exact\n"); }), "a quotation mark is not closed");
}

TEST(CandidateFile, NamesItsColumnsByDefaultOrByRequest) {
  EXPECT_EQ(values_of(candidate_of("receiver,exact,approximate\na,1,2\n")).front(), 2.0);
  EXPECT_EQ(values_of(candidate_of("id,value,exact\na,1,2\n")).front(), 1.0);
  const CandidateColumns columns{.value = "ff", .receiver = "point", .source = "lamp"};
  const Candidate candidate = candidate_of("point,lamp,ff,value\na,l,3,4\n", columns);
  EXPECT_EQ(values_of(candidate), std::vector<double>{3.0});
  EXPECT_EQ(texts_of(candidate, "receiver"), std::vector<std::string>{"a"});
  EXPECT_EQ(texts_of(candidate, "source"), std::vector<std::string>{"l"});
}

// As spreadsheets write it where the comma is the decimal sign, with a byte order mark.
TEST(CandidateFile, MayHaveSemicolonsAndDecimalCommas) {
  const Candidate german = candidate_of(
      "\xEF\xBB\xBF"
      "receiver;source;value\r\na;\"l;1\";0,25\r\nb;m;1,5E-05\r\n");
  EXPECT_EQ(values_of(german), (std::vector<double>{0.25, 1.5e-5}));
  EXPECT_EQ(texts_of(german, "source"), (std::vector<std::string>{"l;1", "m"}));
  EXPECT_EQ(values_of(candidate_of("receiver;value\na;0.25\n")).front(), 0.25);
  EXPECT_EQ(truth_of("receiver;exact\na;0,5\n").rows.front().value, 0.5);
  EXPECT_HOLDS(complaint([] { (void)candidate_of("receiver;value\na;0,25\nb;0.5\n"); }),
               "mine.csv:3: '0.5' has a decimal point, and a number above it a decimal comma, in column 'value' (");
}

TEST(CandidateFile, MayHoldValuesThatAreNoNumbers) {
  const std::vector<double> values =
      values_of(candidate_of("receiver,value\na,nan\nb,-NaN\nc,inf\nd,-Infinity\ne,1e999\nf,-1e999\ng,1.#IND\n"));
  ASSERT_EQ(values.size(), 7U);
  for (const std::size_t i : {0, 1, 6}) EXPECT_TRUE(std::isnan(values[i])) << i;
  EXPECT_EQ((std::vector(values.begin() + 2, values.begin() + 6)),
            (std::vector{kInfinity, -kInfinity, kInfinity, -kInfinity}));
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

using table::Cell;
using table::Table;
using table::Type;

// Radiosities of two patches; nothing is known of the last one.
Table radiosities() {
  Table made("radiosity", {},
             {{.name = "patch", .type = Type::kText, .key = true},
              {.name = "channel", .type = Type::kText, .key = true},
              {.name = "radiosity"},
              {.name = "lower"},
              {.name = "upper"},
              {.name = "irradiance"},
              {.name = "irradiance_lower"},
              {.name = "irradiance_upper"},
              {.name = "claim", .type = Type::kText}});
  using Row = std::vector<Cell>;
  for (const Row& row : std::vector<Row>{{"a", "red", 0.5, 0.25, 0.75, 1.0, 0.5, 2.0, "estimated"},
                                         {"a", "blue", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, "zero"},
                                         {"b", "red", Cell(), 0.125, Cell(), Cell(), Cell(), Cell(), "no bound"}}) {
    made.append(row);
  }
  return made;
}

class CheckOfTables : public testing::Test {
 protected:
  std::filesystem::path write(const Table& made, const std::string& name) const {
    table::write(made, directory_.path() / name);
    return directory_.path() / name;
  }
  const TemporaryDirectory directory_;
};

TEST_F(CheckOfTables, RadiositiesAreJudgedByTheirBounds) {
  for (const char* name : {"r.csv", "r.npz", "r.jsonl"}) {
    SCOPED_TRACE(name);
    const auto truth = write(radiosities(), name);
    const auto mine = directory_.write("mine.csv", "patch,channel,value\nb,red,7\na,blue,0\na,red,1\n");
    const Report report = compare(truth, mine, {.criteria = {.max_abs = 0.25}});
    EXPECT_TRUE(report.passed());
    EXPECT_EQ(report.column, "radiosity");
    EXPECT_EQ(report.overall.absolute.max, 0.25);
    EXPECT_EQ(report.not_certified, 1U);
    EXPECT_EQ(report.worst.front().name, "patch 'a', channel 'red'");
    EXPECT_EQ(read_truth(truth, "irradiance").rows[0].upper, 2.0);
    EXPECT_HOLDS(complaint([&] { (void)compare(truth, directory_.write("m.csv", "patch,channel,value\nc,red,7\n")); }),
                 "m.csv:2: the truth has no patch 'c' of channel 'red' (");
  }
}

TEST_F(CheckOfTables, ASuiteIsGradedOnEachLevel) {
  const std::filesystem::path suite = EXACTFF_DATA_DIR "/suite";
  const std::vector<std::filesystem::path> files = {
      directory_.write("some.csv", "question,value\nplates-1,0.003162056838757602\nplates-6,0.42\ncover-1,0\n"),
      directory_.write("one.csv", "question,value\ntable-1,nan\n")};
  const Scoreboard board = scoreboard(suite, files, {.criteria = {.max_abs = 1e-3}});
  const Report& some = board.scores[0].report;
  ASSERT_EQ(some.levels.size(), 4U);
  EXPECT_EQ(some.levels[3].name, "hard");
  EXPECT_EQ(some.sources, (std::vector<std::string>{"plain", "hard"}));
  EXPECT_FALSE(verdict_on(some, "max-abs", "plain").passed);
  EXPECT_TRUE(verdict_on(some, "max-abs", "hard").passed);
  const std::string lines = markdown(board);
  EXPECT_HOLDS(lines, "| some    | FAILED | 2 of 70: all digits, worst 0.0047 | not asked | not asked | 1 of 38: all");
  EXPECT_HOLDS(lines, " 0 of 66 |");  // what is no number was asked all the same
  const auto folder = directory_.path() / "board";
  check::write(board, folder);
  const auto json = nlohmann::json::parse(text_of(folder / "scoreboard.json"));
  EXPECT_EQ(json["programs"][0]["levels"][0]["answered"], 2);
  EXPECT_EQ(json["programs"][0]["levels"][3]["limits_kept"], 1);
  EXPECT_EQ(json["programs"][1]["levels"][1]["answered"], 0);
  EXPECT_HOLDS(text_of(folder / "index.html"), ">FAILED</td><td data-label=\"answered\">0 of 66</td>");
  EXPECT_HOLDS(text_of(folder / "index.html"), "Level: crowded");
  EXPECT_HOLDS(text_of(folder / "index.html"), "suite (version 1.0)</code>");
  const auto unknown = directory_.write("unknown.csv", "question,value\nplates-0,1\n");
  EXPECT_HOLDS(complaint([&] { (void)compare(suite, unknown); }), "the truth has no question 'plates-0'");
  EXPECT_HOLDS(complaint([&] { (void)compare(suite / "questions.csv", unknown); }), "give its folder");
}

// A table of the future: three keys, a column of its own.
TEST_F(CheckOfTables, AnyKeysAndColumnsWillDo) {
  Table made("path", {},
             {{.name = "from", .type = Type::kText, .key = true},
              {.name = "via", .type = Type::kText, .key = true},
              {.name = "to", .type = Type::kCount, .key = true},
              {.name = "length", .strength = table::Strength::kEstimated}});
  made.append(std::vector<Cell>{"a", "b", std::uint64_t{1}, 0.5});
  made.append(std::vector<Cell>{"a", "c", std::uint64_t{1}, 0.25});
  const auto truth = write(made, "p.jsonl");
  const auto mine = directory_.write("mine.csv", "from,to,via,value\na,1,c,0.25\na,1,b,0.75\n");
  const Report report = compare(truth, mine);
  EXPECT_EQ(report.column, "length");
  ASSERT_EQ(report.worst.size(), 1U);
  EXPECT_EQ(report.worst.front().source, "b, 1");
}

}  // namespace
}  // namespace exactff::check
