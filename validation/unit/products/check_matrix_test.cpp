// A matrix of another program, judged by one of ours.
#include <nlohmann/json.hpp>

#include "check/report.h"
#include "files/numpy.h"
#include "support/test.h"

namespace exactff::check {
namespace {

// The rows of a matrix as `exactff matrix -o` writes them. Rows:
// from,to,factor,lower,upper,claim,way,accurate,area_from.
std::string matrix_text(const std::string& rows, const std::string& further = "\"(back)\"") {
  const auto text = table::Type::kText;
  const table::Table empty("matrix", {},
                           {{.name = "from", .type = text, .key = true},
                            {.name = "to", .type = text, .key = true},
                            {.name = "factor"},
                            {.name = "lower"},
                            {.name = "upper"},
                            {.name = "claim", .type = text},
                            {.name = "way", .type = text},
                            {.name = "accurate", .type = table::Type::kFlag},
                            {.name = "area_from"}});
  std::string all = table::csv_text(empty);
  all.insert(all.find("\"columns\""), "\"further\":[" + further + "],");
  return all + rows;
}

class CheckMatrix : public testing::Test {
 protected:
  // Areas 1, 2 and 4. F_ab = 0.5 within 1e-3; F_ac is by points and wide.
  void SetUp() override {
    truth_ = write("truth.csv", matrix_text("a,a,0,0,0,zero,cells,yes,1\n"
                                            "a,b,0.5,0.4995,0.5005,estimated,cells,yes,1\n"
                                            "a,c,0.4,0.35,0.45,estimated,points,no,1\n"
                                            "a,(back),0.1,0.1,0.1,estimated,cells,yes,1\n"
                                            "b,a,0.25,0.24975,0.25025,estimated,cells,yes,2\n"
                                            "b,b,0,0,0,zero,cells,yes,2\n"
                                            "b,c,0.5,0.5,0.5,estimated,cells,yes,2\n"
                                            "b,(back),0.25,0.25,0.25,estimated,cells,yes,2\n"
                                            "c,a,0.1,0.0875,0.1125,estimated,points,no,4\n"
                                            "c,b,0.25,0.25,0.25,estimated,cells,yes,4\n"
                                            "c,c,0,0,0,zero,cells,yes,4\n"
                                            "c,(back),0.65,0.65,0.65,estimated,cells,yes,4\n"));
  }
  std::string write(const std::string& name, const std::string& text) const {
    return directory_.write(name, text).string();
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  Report report(const std::string& candidate, const Criteria& criteria = {}) const {
    return compare(truth_, candidate, {.criteria = criteria});
  }
  std::string refusal(const std::string& candidate) const {
    return complaint([&] { (void)report(candidate); });
  }
  // In the order a, b, c; with 0.2 for F_ac, which is 0.15 below its bounds.
  static std::vector<double> numbers() { return {0, 0.5004, 0.2, 0.25, 0, 0.5, 0.1, 0.25, 0}; }
  static std::string view3d(const std::string& areas) {
    return "View3D 3.5 0 0 1 3\n" + areas + "\n0 0.5004 0.2\n0.25 0 0.5\n0.1 0.25 0\n0.9 0.9 0.9\n";
  }
  static constexpr const char* kFoam = "FoamFile { format ascii; }\n// * * *\n";
  // Records of Fortran: the version, the diagonal, the others, and one more.
  static std::string calculix(const std::vector<double>& diagonal, const std::vector<double>& others) {
    std::string bytes;
    for (const std::vector<double>& record : {std::vector{0.0}, diagonal, others, diagonal}) {
      const auto length = static_cast<std::uint32_t>(record.size() * sizeof(double));
      const std::string mark(reinterpret_cast<const char*>(&length), 4);
      bytes += mark + std::string(reinterpret_cast<const char*>(record.data()), length) + mark;
    }
    return bytes;
  }
  void expect_same_errors(const Report& found) const {
    EXPECT_EQ(found.overall.rows, 9U);
    EXPECT_NEAR(found.overall.absolute.max, 0.15, 1e-12);
    ASSERT_EQ(found.worst.size(), 1U);  // all the others are within their bounds
    EXPECT_EQ(found.worst[0].receiver, "a");
    EXPECT_EQ(found.worst[0].source, "c");
    EXPECT_NEAR(found.worst[0].error, -0.15, 1e-12);
    EXPECT_NEAR(found.worst[0].relative, 0.15 / 0.35, 1e-12);
  }

  const TemporaryDirectory directory_;
  std::string truth_;
};

TEST_F(CheckMatrix, ASumOfAGroupIsNoPartOfItsRow) {
  const auto rows = [](const char* b, const char* sum) {
    return std::string("a,b,") + b +
           ",0.5,0.5,estimated,cells,yes,1\na,c,0.25,0.25,0.25,estimated,cells,yes,1\na,(sum d)," + sum +
           ",0.75,0.75,estimated,cells,yes,1\n";
  };
  const std::string truth = write("sums.csv", matrix_text(rows("0.5", "0.75"), "\"(sum d)\""));
  const std::string changed = write("changed.csv", matrix_text(rows("0.625", "0.875"), "\"(sum d)\""));
  const Report found = compare(truth, changed, {});
  EXPECT_EQ(found.overall.absolute.max, 0.125);
  ASSERT_TRUE(found.matrix && found.matrix->row_sum);
  EXPECT_EQ(found.matrix->row_sum->by, 0.125);
}

TEST_F(CheckMatrix, EveryFormGivesTheSameErrors) {
  const std::vector<std::size_t> shape{3, 3};
  (void)write("globalFaceFaces", std::string(kFoam) + "3(2(1 2) 2(0 2) 3(0 1 2))\n");
  files::write_npy<double>(path("m.npy"), shape, numbers());
  const Words forms = {
      write("list.csv",
            "to,from,value\nc,a,0.2\na,a,0\nb,a,0.5004\na,b,0.25\nb,b,0\nc,b,0.5\na,c,0.1\nb,c,0.25\nc,c,0\n"),
      write("ours.csv",
            "from,to,factor\na,a,0\na,b,0.5004\na,c,0.2\nb,a,0.25\nb,b,0\nb,c,0.5\nc,a,0.1\nc,b,0.25\nc,c,0\n"),
      write("named.csv", "from,b,a,c\nb,0,0.25,0.5\na,0.5004,0,0.2\nc,0.25,0.1,0\n"),
      write("without_corner.txt", "a b c\nb 0.25 0 0.5\na 0 0.5004 0.2\nc 0.1 0.25 0\n"),
      write("semicolons.csv", "0;0,5004;0,2\n0,25;0;0,5\n0,1;0,25;0\n"),
      write("named_semicolons.csv", "from;b;a;c\nb;0;0,25;0,5\na;0,5004;0;0,2\nc;0,25;0,1;0\n"),
      write("list_semicolons.csv",
            "from;to;value\na;a;0\na;b;0,5004\na;c;0,2\nb;a;0,25\nb;b;0\nb;c;0,5\nc;a;0,1\nc;b;0,25\nc;c;0\n"),
      write("numbers.csv", "# by hand\n0,0.5004,0.2\n0.25,0,0.5\n0.1,0.25,0\n"),
      write("numbers.txt", "0 5.004e-01 0.2\n0.25 0 0.5\n0.1 0.25 0\n"),
      write("view3d.out", view3d("1 2 4")),
      write(
          "zone.idf",
          "Version, 9.4;\n! by hand\nZoneProperty:UserViewFactors:bySurfaceName, zone,\n  a, a, 0, a,b, 0.5004, a, c,\n"
          "0.2, b, a, 0.25, b, b, 0, b, c, 0.5, ! and\n c, a, 0.1, c, b, 0.25, c, c, 0;\n"),
      write("F", std::string(kFoam) + "3(2(0.5004 0.2)\n2(0.25 0.5) 3(0.1 0.25 0))\n"),
      write("ccx.vwf", calculix({0, 0, 0}, {0.25, 0.1, 0.25, 0.5004, 0.2, 0.5})),
      path("m.npy")};
  for (const std::string& form : forms) {
    SCOPED_TRACE(form);
    expect_same_errors(report(form));
  }
}

// The distance from the bounds, on both sides; a proved zero is exact.
TEST_F(CheckMatrix, AnErrorIsTheDistanceFromTheBounds) {
  const Report high = report(write("high.csv", "0.001,0.501,0.45\n0.25,0,0.5\n0.1,0.25,0\n"));
  ASSERT_EQ(high.worst.size(), 2U);
  EXPECT_NEAR(high.worst[0].error, 0.001, 1e-15);
  EXPECT_NEAR(high.worst[1].error, 0.0005, 1e-15);
  EXPECT_EQ(high.overall.leaks, 1U);
  const Report low = report(write("low.csv", "0,0.499,0.35\n0.25,0,0.5\n0.1,0.25,0\n"));
  ASSERT_EQ(low.worst.size(), 1U);
  EXPECT_NEAR(low.worst[0].error, -0.0005, 1e-15);
}

TEST_F(CheckMatrix, WhatNoMatrixMayBeIsTold) {
  const MatrixFacts facts = report(write("m.csv", "-0.1,1.31,0.4\n0.25,0,0.5\n0.1,0.3,0\n")).matrix.value();
  EXPECT_EQ(facts.negative, 1U);
  EXPECT_EQ(facts.least.by, -0.1);
  EXPECT_EQ(facts.above_one, 1U);
  EXPECT_EQ(facts.largest.by, 1.31);
  EXPECT_EQ(facts.largest.to, "b");
  EXPECT_NEAR(facts.row_sum->by, 1.61 - 0.9505, 1e-12);
  EXPECT_EQ(facts.row_sum->from, "a");
  EXPECT_NEAR(facts.reciprocity->by, 1.31 - 2 * 0.25, 1e-12);  // of the area of a
  EXPECT_EQ(sentences(facts).size(), 4U);
  const MatrixFacts sound = report(write("s.csv", "0,0.5,0.4\n0.25,0,0.5\n0.1,0.25,0\n")).matrix.value();
  EXPECT_EQ(sound.negative + sound.above_one, 0U);
  EXPECT_EQ(sound.row_sum->by, 0.0);
  EXPECT_NEAR(sound.reciprocity->by, 0.0, 1e-15);
}

TEST_F(CheckMatrix, WhatCannotBeComparedIsRefusedWithItsPlace) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {write("a", "from,to,value\na,a,0\n"), "no value for 8 of 9 values"},
      {write("b", "from,to,value\na,d,0\n"), "b:2: the truth has no column 'd'"},
      {write("c", "from,to,value\nd,a,0\n"), "c:2: the truth has no row 'd' of column 'a'"},
      {write("d", "0,1\n1,0\n"), "of 2 x 2, and the truth is 3 x 3"},
      {write("e", "0,1,2\n1,0\n"), "e:2: 2 numbers where the first row has 3"},
      {write("f", "0,1,2\n1,0,x\n1,2,3\n"), "f:2: 'x'"},
      {write("g", view3d("1 2 5")), "surface 3 has the area 5, and 'c' has 4"},
      {write("h", "View3D 3.5 0 0 1 3\n1 2 4\n0 0 0\n"), "has 6 numbers"},
      {write("i", "View3D 3.5 1 0 1 3\n1 2 4\n"), "in the format 1"},
      {write("j", "View3D 3.5 0 0 1 99999999\n1 2 4\n"), "is cut off"},
      {write("k", std::string("PK\3\4") + "rest"), "is a zip archive"},
      {write("l", "from,a,b\na,0\n"), "l:2: 2 fields"},
      {write("m", "\x93NUMPY"), "is cut off"},
      {write("n", ""), "has no entries"},
      {write("o.vwf", "1234"), "is cut off"},
      {write("p", std::string(kFoam) + "3(2(1 2"), "is no list of lists"},
      {write("q", "ZoneProperty:UserViewFactors:bySurfaceName, zone, a, b;"), "q:1: the object ends within a pair"},
      {path("missing.csv"), "missing.csv"}};
  for (const auto& [file, words] : cases) {
    EXPECT_HOLDS(refusal(file), words) << file << ": " << refusal(file);
  }
  for (const auto& [rows, words] :
       {std::pair("a,a,0.5,0.6,0.7,estimated,cells,yes,1\n", "bad.csv:3: the value is not within its bounds"),
        std::pair("a,a,0,0,0,perfect,cells,yes,1\n", "bad.csv:3: unknown claim 'perfect'"),
        std::pair("a,a,0,0,0,zero,cells,yes,1\na,a,0,0,0,zero,cells,yes,1\n",
                  "bad.csv:4: row 'a' has a second entry of column 'a' (the first is line 3)")}) {
    truth_ = write("bad.csv", matrix_text(rows));
    EXPECT_HOLDS(refusal(write("one", "a\na 0\n")), words);
  }
}

TEST(ReadNpy, IsWhatNumpyWrites) {
  const TemporaryDirectory directory;
  const auto file = [&](const std::string& descr, const char* order, const std::string& shape, std::string elements) {
    std::string header = "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
    header.resize(118 - 1, ' ');
    header += '\n';
    return directory.write(
        "m.npy", std::string("\x93NUMPY\1") + '\0' + char(header.size()) + '\0' + header + std::move(elements));
  };
  const auto floats = [](std::vector<float> values) {
    return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  };
  files::NpyArray array = files::read_npy(file("<f4", "False", "(2, 3)", floats({1, 2, 3, 4, 5, 6})));
  EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(array.values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  array = files::read_npy(file("<f4", "True", "(2, 3)", floats({1, 4, 2, 5, 3, 6})));
  EXPECT_EQ(array.values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  array = files::read_npy(file(">f8", "False", "(1,)", std::string("\x3f\xf8\0\0\0\0\0\0", 8)));
  EXPECT_EQ(array.values, (std::vector<double>{1.5}));
  EXPECT_THROW((void)files::read_npy(file("<f4", "False", "(2, 3)", floats({1}))), InputError);
  for (const char* shape : {"(1,)", "(4294967296, 4294967296)", "(99999999999999999999,)"}) {
    EXPECT_THROW((void)files::read_npy(file(shape == std::string("(1,)") ? "<i8" : "<f8", "False", shape, "12345678")),
                 InputError);
  }
}

TEST_F(CheckMatrix, TheCommandJudgesWritesAndHoldsABaseline) {
  const std::string mine = write("view3d.out", view3d("1 2 4"));
  const auto check = [&](const Words& flags) { return run_exactff(joined({"check", truth_, mine}, flags)); };
  const ProgramRun failed = check({"--max-abs", "0.1", "--junit", path("a.xml"), "--json", path("a.json")});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_HOLDS(failed.output, "sums of rows are at most");
  EXPECT_HOLDS(text_of(path("a.xml")), "row 'a', column 'c'");
  const auto json = nlohmann::json::parse(text_of(path("a.json")));
  EXPECT_EQ(json["matrix"]["negative"], 0);
  EXPECT_EQ(json["worst"][0]["status"], "estimated");
  EXPECT_EQ(check({"--max-abs", "0.2"}).exit_code, 0);
  EXPECT_EQ(check({"--write-baseline", path("base.json")}).exit_code, 0);
  EXPECT_EQ(check({"--baseline", path("base.json")}).exit_code, 0);
  const std::string worse = write("worse.csv", "0,0.5004,0.1\n0.25,0,0.5\n0.1,0.25,0\n");
  EXPECT_EQ(run_exactff({"check", truth_, worse, "--baseline", path("base.json")}).exit_code, 1);
  for (const Words& flags : std::vector<Words>{
           {"--match", "position"}, {"--truth-column", "middle"}, {"--eps-b", "1"}, {"--error-image", path("e.png")}}) {
    EXPECT_EQ(check(flags).exit_code, 2) << flags.front();
  }
}

// What matrix writes for View3D is what check reads.
TEST_F(CheckMatrix, OurOwnFilesAgree) {
  const std::string scene = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
  EXPECT_EQ(run_exactff({"matrix", scene, "-o", path("m.csv"), "--view3d", path("m.out")}).exit_code, 0);
  EXPECT_EQ(run_exactff({"check", path("m.csv"), path("m.out"), "--max-abs", "5e-7"}).exit_code, 0);
  EXPECT_EQ(run_exactff({"check", path("m.csv"), path("m.csv"), "--max-abs", "0"}).exit_code, 0);
}

}  // namespace
}  // namespace exactff::check
