// --flip and --transparent in every command, and what the commands say on their own about fronts and glass.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/program.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::text_of;

// A floor, a lamp above it that looks up, and a pane of glass between them.
constexpr const char* kRoom =
    "mtllib room.mtl\n"
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 3\nv 2 1 3\nv 2 2 3\nv 1 2 3\nv 0 0 1\nv 4 0 1\nv 4 4 1\nv 0 4 1\n"
    "usemtl grey\ng floor\nf 1 2 3 4\nusemtl bright\ng lamp\nf 5 6 7 8\nusemtl glass\ng pane\nf 9 10 11 12\n";
constexpr const char* kMaterials = "newmtl grey\nKd .5\nnewmtl bright\nKe 5\nnewmtl glass\nd .1\n";

class ChangedFaces : public testing::Test {
 protected:
  ChangedFaces() {
    (void)directory_.write("room.mtl", kMaterials);
    room_ = directory_.write("room.obj", kRoom);
  }

  struct Run {
    int exit_code = 0;
    std::string output, error;
    bool said(const std::string& part) const { return error.find(part) != std::string::npos; }
    bool printed(const std::string& part) const { return output.find(part) != std::string::npos; }
  };
  // Twice, because a run shows either standard output or standard error to the test.
  Run run(const std::vector<std::string>& arguments) const {
    const validation::RunningProgram program(EXACTFF_PROGRAM, arguments, directory_.path() / "stderr",
                                             [] { ::setenv("PATH", "/nonexistent", 1); });
    Run result;
    result.exit_code = program.wait();
    result.error = program.error();
    if (arguments.front() == "info" || arguments.front() == "point")
      result.output = validation::run_program(EXACTFF_PROGRAM, arguments).output;
    return result;
  }
  Run with(std::vector<std::string> arguments, const std::vector<std::string>& more) const {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  Run point(const std::vector<std::string>& more) const {
    return with({"point", room_, "--at", "1.5", "1.5", "0", "--normal", "0", "0", "1", "--source", "lamp", "--plain"},
                more);
  }
  Run truth(const std::vector<std::string>& more) const {
    return with({"truth", room_, "--on", "floor", "--grid", "8x16", "--force", "-o", truth_}, more);
  }
  Run compare(const std::vector<std::string>& more) const {
    return with({"compare", room_, "--on", "floor", "--grid", "3x3", "--no-methods", "--eps-b", ".1", "--rays", "1",
                 "--seeds", "1", "--pattern", "jittered", "--variant", "mended", "-o", out_},
                more);
  }

  const validation::TemporaryDirectory directory_;
  std::string room_;
  const fs::path truth_ = directory_.path() / "truth.csv", out_ = directory_.path() / "out";
};

const std::vector<std::string> kBoth = {"--flip", "lamp", "--transparent", "pane"};

TEST_F(ChangedFaces, PointTakesBoth) {
  EXPECT_EQ(point({}).output, "0\n");
  EXPECT_EQ(point({"--flip", "lamp"}).output, "0\n") << "the pane hides it";
  EXPECT_EQ(point({"--transparent", "pane"}).output, "0\n") << "it looks up";
  const Run both = point(kBoth);
  EXPECT_TRUE(both.output.starts_with("0.03")) << both.output;
  EXPECT_EQ(both.error, "");
  EXPECT_EQ(point({"--flip", "lamp:1,floor", "--transparent", "pane:1"}).output, both.output);
  EXPECT_EQ(point({"--flip", "lamp", "--flip", "floor", "--transparent", "pane"}).output, both.output);
}

TEST_F(ChangedFaces, UnknownNamesAreRefused) {
  for (const char* flag : {"--flip", "--transparent"}) {
    const Run unknown = point({flag, "lampe"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_TRUE(unknown.said("there is no patch named 'lampe'")) << unknown.error;
    EXPECT_EQ(point({flag}).exit_code, 2) << "a name must follow";
  }
}

TEST_F(ChangedFaces, PointSaysWhatToDo) {
  const Run dark = point({"--transparent", "pane"});
  EXPECT_TRUE(dark.said("the receiver is behind every face of 'lamp'")) << dark.error;
  EXPECT_TRUE(dark.said("turn it round with --flip lamp\n")) << dark.error;
  EXPECT_FALSE(dark.said("lets light through")) << dark.error;
  EXPECT_TRUE(point({"--flip", "lamp"}).said("give --transparent pane\n"));
}

TEST_F(ChangedFaces, AreInTheHeaderOfATruthFile) {
  EXPECT_EQ(truth(kBoth).exit_code, 0);
  const std::string text = text_of(truth_);
  EXPECT_NE(text.find("\"flipped\":[\"lamp\"],\"transparent\":[\"pane\"],\"receivers\":"), std::string::npos)
      << text.substr(0, 600);
  EXPECT_EQ(text.find(",zero\n"), std::string::npos);
  EXPECT_EQ(truth({}).exit_code, 0);
  EXPECT_EQ(text_of(truth_).find("flipped"), std::string::npos);
  EXPECT_EQ(text_of(truth_).find("transparent"), std::string::npos);
}

TEST_F(ChangedFaces, BelongToTheRequestOfATruthFile) {
  EXPECT_EQ(truth(kBoth).exit_code, 0);
  const std::string whole = text_of(truth_);
  const auto resume = [&](const std::vector<std::string>& flags) {
    return with({"truth", room_, "--on", "floor", "--grid", "8x16", "--resume", "-o", truth_}, flags);
  };
  EXPECT_EQ(resume(kBoth).exit_code, 0);
  for (const std::vector<std::string>& other : std::vector<std::vector<std::string>>{
           {}, {"--flip", "lamp"}, {"--transparent", "pane"}, {"--flip", "lamp,floor", "--transparent", "pane"}}) {
    const Run refused = resume(other);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(refused.said("belongs to a different request")) << refused.error;
  }
  EXPECT_EQ(text_of(truth_), whole);
}

TEST_F(ChangedFaces, OfShardsMustAgree) {
  const auto shard = [&](const char* which, const std::vector<std::string>& flags) {
    const fs::path file = directory_.path() / (std::string(1, which[0]) + ".csv");
    EXPECT_EQ(with({"truth", room_, "--on", "floor", "--grid", "8x16", "--force", "-o", file, "--shard", which}, flags)
                  .exit_code,
              0);
    return file.string();
  };
  const std::string one = shard("1/2", kBoth);
  const std::string other = shard("2/2", {"--flip", "lamp"});
  const fs::path merged = directory_.path() / "merged.csv";
  const Run refused = run({"merge", one, other, "-o", merged});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(refused.said("belongs to a different request")) << refused.error;
  EXPECT_EQ(run({"merge", one, shard("2/2", kBoth), "-o", merged}).exit_code, 0);
  EXPECT_EQ(truth(kBoth).exit_code, 0);
  EXPECT_EQ(text_of(merged), text_of(truth_));
  EXPECT_EQ(run({"check", truth_, merged, "--max-abs", "0"}).exit_code, 0);
}

TEST_F(ChangedFaces, AreInTheTablesAndTheReportOfCompare) {
  const Run run = compare(kBoth);
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_FALSE(run.said("gives 0")) << run.error;
  const std::string table = text_of(out_ / "exact.csv");
  EXPECT_NE(table.find("\n# flipped: lamp\n# transparent: pane\n# receivers: "), std::string::npos)
      << table.substr(0, 600);
  const std::string report = text_of(out_ / "report.html");
  EXPECT_NE(report.find("flipped: lamp; transparent: pane"), std::string::npos);
  EXPECT_NE(report.find("--flip lamp --transparent pane --on floor"), std::string::npos) << "the command line";
}

TEST_F(ChangedFaces, AreFlagsOfASceneInAStudy) {
  const std::string line =
      "scene room.obj --on floor --grid 3x3 --no-methods --eps-b .1 --rays 1 --seeds 1 --pattern jittered --variant "
      "mended --title ";
  const std::string study =
      directory_.write("a.study", line + "A\n" + line + "B --flip lamp --transparent pane\n").string();
  const Run both = run({"compare", study, "-o", out_});
  EXPECT_EQ(both.exit_code, 0) << both.error;
  EXPECT_EQ(text_of(out_ / "a_exact.csv").find("# flipped"), std::string::npos);
  EXPECT_NE(text_of(out_ / "b_exact.csv").find("# flipped: lamp\n# transparent: pane\n"), std::string::npos);
  EXPECT_TRUE(both.said("warning: A: source 'lamp' gives 0 at all 9 receivers")) << both.error;
  EXPECT_FALSE(both.said("B: source")) << both.error;
  EXPECT_TRUE(both.said("give --transparent pane\n")) << both.error;
}

TEST_F(ChangedFaces, TruthAndCompareSayWhyEverythingIsDark) {
  const std::string behind =
      "warning: source 'lamp' gives 0 at all 128 receivers: they are behind the source (a source emits only from its "
      "front); if the other side of 'lamp' is meant, turn it round with --flip lamp\n";
  EXPECT_TRUE(truth({}).said(behind)) << truth({}).error;
  const Run turned = truth({"--flip", "lamp,floor", "--transparent", "pane"});
  EXPECT_TRUE(turned.said("they look away from the source")) << turned.error;
  EXPECT_TRUE(turned.said("leave out --flip for 'floor'\n")) << turned.error;
  const Run compared = compare({"--transparent", "pane"});
  EXPECT_TRUE(compared.said("source 'lamp' gives 0 at all 9 receivers: they are behind the source")) << compared.error;
  EXPECT_FALSE(truth({"--flip", "lamp"}).said("gives 0")) << "the pane hides it: no slip that can be told";
}

TEST_F(ChangedFaces, InfoShowsFindingsAndProposesWhatWorks) {
  const Run plain = run({"info", room_});
  EXPECT_TRUE(plain.printed("check: emitter 'lamp' looks away from everything")) << plain.output;
  EXPECT_TRUE(plain.printed("turn it round with --flip lamp\n")) << plain.output;
  EXPECT_TRUE(plain.said("give --transparent pane\n")) << plain.error;
  const Run mended = with({"info", room_}, kBoth);
  EXPECT_FALSE(mended.printed("check: emitter")) << mended.output;
  EXPECT_EQ(mended.error, "");
  EXPECT_TRUE(mended.printed("next: exactff compare " + room_ + " --flip lamp --transparent pane --on "))
      << mended.output;
  EXPECT_TRUE(mended.printed("--source lamp --grid 16x16 -o DIR")) << mended.output;
  const nlohmann::json json = nlohmann::json::parse(run({"info", room_, "--json", "--transparent", "pane"}).output);
  ASSERT_EQ(json["findings"].size(), 1U) << json["findings"];
  EXPECT_EQ(json["findings"][0]["kind"], "emitter-looks-away");
  EXPECT_EQ(json["findings"][0]["flag"], "--flip lamp");
  EXPECT_EQ(json["findings"][0]["objects"], std::vector<std::string>{"lamp"});
}

// A face a billionth above the floor, which hides everything from it. Each command that places points on faces counts
// them, and is silent once its advice is obeyed.
TEST_F(ChangedFaces, EveryCommandTellsOfFacesThatHideItsPoints) {
  const std::string covered =
      directory_
          .write("covered.obj",
                 "mtllib room.mtl\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 3\nv 2 1 3\nv 2 2 3\nv 1 2 3\n"
                 "v -1 -1 1e-9\nv 9 -1 1e-9\nv -1 9 1e-9\n"
                 "usemtl grey\ng floor\nf 1 2 3 4\nusemtl bright\ng lamp\nf 8 7 6 5\nusemtl grey\ng cover\nf 9 10 11\n")
          .string();
  const std::string file = (directory_.path() / "written").string();
  const std::vector<std::string> on = {"--at", "1.5", "1.5", "0", "--normal", "0", "0", "1", "--on", "floor"},
                                 grid = {"--on", "floor", "--grid", "3x3", "--force", "-o"};
  const auto with_all = [&](std::vector<std::string> command, const std::vector<std::string>& more) {
    command.insert(command.begin() + 1, covered);
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  std::vector<std::vector<std::string>> commands = {
      with_all({"point", "--source", "lamp"}, on),
      with_all({"view"}, on),
      with_all({"truth"}, {grid.begin(), grid.end()}),
      with_all({"matrix", "--from", "floor", "--to", "lamp"}, {}),
      with_all({"radiosity", "--accuracy", "1e-2", "--force", "-o", file + ".csv"}, {}),
      with_all({"render", "--size", "4x4", "--force", "-o", file + ".exr"}, {}),
      with_all({"compare", "--no-methods", "--eps-b", ".1", "--rays", "1", "--seeds", "1", "--pattern", "jittered",
                "--variant", "mended"},
               grid)};
  for (std::vector<std::string>& command : commands) {
    if (command.back() == "-o") command.push_back(command.front() == "compare" ? file : file + ".csv");
    const Run told = run(command), mended = with(command, {"--transparent", "cover"});
    EXPECT_TRUE(told.said("nearly in its plane and hides everything; --transparent cover lets light pass through it"))
        << command.front() << ": " << told.error;
    EXPECT_FALSE(mended.said("nearly in its plane")) << command.front() << ": " << mended.error;
    EXPECT_TRUE(mended.exit_code == 0 || mended.exit_code == 3) << command.front() << ": " << mended.error;
  }
}

}  // namespace
}  // namespace exactff
