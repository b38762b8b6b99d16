#include <nlohmann/json.hpp>

#include "files/numpy.h"
#include "support/test.h"
#include "text/phrases.h"

namespace exactff {
namespace {

// Tables with single blanks between columns, because column widths depend on the other rows.
std::string squeezed(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c != ' ' || !result.ends_with(' ')) result += c;
  }
  return result;
}

bool holds_row(const std::string& text, const std::string& part) {
  return squeezed(text).find(squeezed(part)) != std::string::npos;
}

#define EXPECT_ROW(text, part) EXPECT_TRUE(holds_row(text, part)) << "\"" << (part) << "\" is not in:\n" << (text)

// Three receivers and two sources; the candidate has the error `error` at receiver b and source t.
class CheckCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    truth_ = directory_
                 .write("truth.csv",
                        "# by hand\nreceiver,x,y,z,nx,ny,nz,source,exact,largest_rho_b\n"
                        "a,0,0,0,0,0,1,s,0.5,10\na,0,0,0,0,0,1,t,0.25,10\nb,1,0,0,0,0,1,s,0.125,10\n"
                        "b,1,0,0,0,0,1,t,0.25,10\nc,2,0,0,0,0,1,s,0,10\nc,2,0,0,0,0,1,t,0.25,10\n")
                 .string();
  }
  std::string candidate(const std::string& b_t, const std::string& name = "mine.csv") const {
    return directory_
        .write(name, "receiver,source,value\na,s,0.5\na,t,0.25\nb,s,0.125\nb,t," + b_t + "\nc,s,0\nc,t,0.25\n")
        .string();
  }
  ProgramRun check(const std::string& file, Words flags) const {
    return run_exactff(joined({"check", truth_, file}, flags));
  }
  std::string path(const std::string& name) const { return (directory_.path() / name).string(); }

  TemporaryDirectory directory_;
  std::string truth_;
};

TEST_F(CheckCommand, JudgesByEveryLimit) {
  const std::string mine = candidate("0.375");  // 0.125 of 0.25
  const std::vector<Words> kept = {
      {"--max-abs", "0.125"},
      {"--max-rel", "0.5"},
      {"--rms", "0.0511"},
      {"--eps-b", "1.25"},
      {"--quantile", "0.83=0"},
      {"--quantile", "1=0.125"},
      {"--max-rel", "0.125", "--relative-floor", "1"},
      {"--rms", "0.0722", "--per-source"},
  };
  const std::vector<Words> broken = {
      {"--max-abs", "0.124"},
      {"--max-rel", "0.49"},
      {"--rms", "0.051"},
      {"--eps-b", "1.24"},
      {"--quantile", "0.84=0.1"},
      {"--quantile", "0.5=0", "--quantile", "1=0.1"},
      {"--max-rel", "0.124", "--relative-floor", "1"},
      {"--rms", "0.0721", "--per-source"},
  };
  for (const auto& flags : kept) EXPECT_EQ(check(mine, flags).exit_code, 0) << flags[0] << ' ' << flags[1];
  for (const auto& flags : broken) EXPECT_EQ(check(mine, flags).exit_code, 1) << flags[0] << ' ' << flags[1];
}

TEST_F(CheckCommand, MatchesByPosition) {
  const std::string mine =
      directory_
          .write("places.csv",
                 "px,py,pz,lamp,ff\n2.001,0,0,t,.25\n2,0,0,s,0\n1,0,0,s,.125\n1,0,0,t,.25\n0,0,0,t,.25\n0,0,0,s,.5\n")
          .string();
  Words flags = {"--match",        "position", "--position-columns", "px,py,pz", "--source-column", "lamp",
                 "--value-column", "ff",       "--max-abs",          "0"};
  EXPECT_EQ(check(mine, flags).exit_code, 2);
  flags.insert(flags.end(), {"--tolerance", "0.01"});
  EXPECT_EQ(check(mine, flags).exit_code, 0);
}

TEST_F(CheckCommand, JudgesSomeRowsOnRequest) {
  const std::string mine = directory_.write("some.csv", "receiver,source,value\nb,t,0.25\n").string();
  EXPECT_EQ(check(mine, {"--max-abs", "0"}).exit_code, 2);
  const ProgramRun run = check(mine, {"--max-abs", "0", "--partial"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_ROW(run.output, "(exact, 6 rows)");
  EXPECT_ROW(run.output, "(1 row judged)");
}

TEST_F(CheckCommand, WritesWhatMachinesRead) {
  const ProgramRun run = check(candidate("0.375"), {"--max-abs", "0.1", "--junit", path("j.xml"), "--json",
                                                    path("j.json"), "--github", "--worst", "1"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_ROW(text_of(path("j.xml")), "<testsuites name=\"exactff check\" tests=\"2\" failures=\"1\"");
  EXPECT_EQ(nlohmann::json::parse(text_of(path("j.json")))["overall"]["absolute"]["max"], 0.125);
  EXPECT_ROW(run.output,
             "::error file=" + path("mine.csv") + ",line=5,title=exactff check%3A max-abs::max-abs: 0.125 is");
}

TEST_F(CheckCommand, AnnotatesBadInput) {
  const ProgramRun run = check(candidate("x"), {"--github"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_ROW(run.output, "::error file=" + path("mine.csv") + ",line=5,title=exactff check%3A bad input::");
}

TEST_F(CheckCommand, DrawsTheHistogram) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  EXPECT_EQ(check(candidate("0.375"), {"--plot", path("h.svg"), "--max-abs", "1"}).exit_code, 0);
  EXPECT_ROW(text_of(path("h.svg")), "</svg>");
  EXPECT_ROW(text_of(path("h.svg")), "max-abs");
}

TEST_F(CheckCommand, HoldsOnToABaseline) {
  const std::string file = path("b.json");
  EXPECT_EQ(check(candidate("0.375"), {"--write-baseline", file}).exit_code, 0);
  EXPECT_EQ(check(candidate("0.375"), {"--baseline", file}).exit_code, 0);
  const ProgramRun worse = check(candidate("0.376"), {"--baseline", file});
  EXPECT_EQ(worse.exit_code, 1);
  EXPECT_ROW(worse.output, "FAIL baseline max-abs all 0.126 0.125\n");
  EXPECT_EQ(check(candidate("0.376"), {"--baseline", file, "--slack", "0.01"}).exit_code, 0);
  const ProgramRun better = check(candidate("0.3125"), {"--baseline", file});
  EXPECT_EQ(better.exit_code, 0);
  EXPECT_ROW(better.output, "Better than baseline max-abs: 0.125 -> 0.0625, 50 % less\n");
  EXPECT_ROW(better.output, "To record this improvement, without --baseline: --write-baseline " + file + '\n');
}

TEST_F(CheckCommand, TightensABaselineAndNeverLoosensIt) {
  const std::string file = path("b.json"), next = path("next.json");
  (void)check(candidate("0.375"), {"--write-baseline", file});
  EXPECT_EQ(check(candidate("0.5"), {"--baseline", file, "--write-baseline", next}).exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(next));
  EXPECT_EQ(check(candidate("0.3125"), {"--baseline", file, "--write-baseline", next}).exit_code, 0);
  EXPECT_EQ(check(candidate("0.375"), {"--baseline", next}).exit_code, 1);
}

TEST_F(CheckCommand, RefusesFlagsThatMeanNothing) {
  const std::string mine = candidate("0.25");
  for (const Words& flags : std::vector<Words>{{"--max-abs", "small"},
                                               {"--max-abs", "-1"},
                                               {"--max-rel", "nan"},
                                               {"--quantile", "0.99"},
                                               {"--quantile", "1.5=1"},
                                               {"--quantile", "x=1"},
                                               {"--match", "name"},
                                               {"--match", "position", "--position-columns", "x,y"},
                                               {"--truth-column", "unoccluded"},
                                               {"--baseline", "none.json"},
                                               {"--slack", "-1", "--baseline", "none.json"},
                                               {"--junit", "no/such/folder/j.xml"}}) {
    EXPECT_EQ(check(mine, flags).exit_code, 2) << flags[0] << ' ' << flags[1];
  }
}

// From the scene to the verdict: the values of a truth file are the candidate, with an error in one of them.
TEST(CheckOfATruthFile, CatchesAThousandthAndForgivesABillionth) {
  const TemporaryDirectory directory;
  const std::string truth = (directory.path() / "truth.csv").string();
  const std::string scene = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";
  ASSERT_EQ(run_exactff({"truth", scene, "--on", "floor", "--grid", "4x4", "-o", truth}).exit_code, 0);
  for (const double bug : {1e-3, 1e-9}) {
    std::string mine = "receiver,value\n";
    for (const check::TruthRow& row : check::read_truth(truth).rows) {
      mine += '"' + row.receiver + "\"," + text::shortest(row.value + (row.receiver == "r3c2" ? bug : 0.0)) + '\n';
    }
    const std::string file = directory.write("mine.csv", mine).string();
    const ProgramRun run = run_exactff({"check", truth, file, "--max-abs", "1e-6", "--eps-b", "1e-6"});
    EXPECT_EQ(run.exit_code, bug == 1e-3 ? 1 : 0) << run.output;
    EXPECT_ROW(run.output, "1 r3c2 light ");
  }
}

TEST_F(CheckCommand, TakesImagesOfNumPyAndNoTableBesideThem) {
  const std::string mine = path("mine.npy");
  const std::vector<std::size_t> shape{1, 2, 3};
  files::write_npy<double>(mine, shape, std::vector<double>{1, 1, 1, 2, 2, 2});
  files::write_npy<double>(path("truth.npy"), shape, std::vector<double>{1, 1, 1, 2, 2, 2.5});
  const ProgramRun run =
      run_exactff({"check", path("truth.npy"), mine, "--max-abs", "0.4", "--error-image", path("e.png")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_ROW(run.output, "1 x1y0 B 2.5 2 -0.5 0.2");
  EXPECT_TRUE(text_of(path("e.png")).starts_with("\x89PNG"));
  EXPECT_EQ(check(mine, {}).exit_code, 2);
}

TEST_F(CheckCommand, SeveralCandidatesAreAScoreboard) {
  const std::string right = candidate("0.25", "right.csv"), wrong = candidate("0.375", "wrong.csv");
  const auto run = [&](const Words& flags) {
    return run_exactff(joined({"check", truth_, right, wrong, "--max-abs", "0.1"}, flags));
  };
  const ProgramRun both = run({"-o", path("board"), "--time", "wrong=2.5"});
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_ROW(both.output, "| right | passed | 6 of 6 | 0 |");
  EXPECT_ROW(both.output, "| wrong | FAILED | 6 of 6 | 0.12 |");
  EXPECT_ROW(both.output, "1 of 2 | 2.5 s |\n");
  EXPECT_ROW(both.error, "failed: wrong: max-abs: 0.125 is above the limit 0.1");
  EXPECT_ROW(text_of(path("board/index.html")), "Every limit is kept by 1 of 2 programs.");
  EXPECT_EQ(run({"--max-rel", "1"}).exit_code, 1);
  EXPECT_EQ(run_exactff({"check", truth_, right, right, "-o", path("board")}).exit_code, 0);
  for (const Words& flags : std::vector<Words>{
           {"--json", path("j.json")}, {"--time", "other=1"}, {"--time", "wrong"}, {"-o", path("board/index.html")}}) {
    EXPECT_EQ(run(flags).exit_code, 2) << flags[0];
  }
}

}  // namespace
}  // namespace exactff
