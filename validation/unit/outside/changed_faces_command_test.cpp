// --flip and --transparent in every command, and what the commands say on their own about fronts and glass.
#include <nlohmann/json.hpp>

#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

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

  struct Run : ProgramRun {
    bool said(const std::string& part) const { return error.find(part) != std::string::npos; }
    bool printed(const std::string& part) const { return output.find(part) != std::string::npos; }
  };
  static Run run(const Words& arguments) { return {run_exactff(arguments)}; }
  Run with(Words arguments, const Words& more) const {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  Run point(const Words& more) const {
    return with({"point", room_, "--at", "1.5", "1.5", "0", "--normal", "0", "0", "1", "--source", "lamp", "--plain"},
                more);
  }
  Run truth(const Words& more) const {
    return with({"truth", room_, "--on", "floor", "--grid", "8x16", "--force", "-o", truth_}, more);
  }
  Run compare(const Words& more) const {
    return with({"compare", room_, "--on", "floor", "--grid", "3x3", "--no-methods", "--eps-b", ".1", "--rays", "1",
                 "--seeds", "1", "--pattern", "jittered", "--variant", "mended", "-o", out_},
                more);
  }

  const EnvironmentVariable without_gnuplot_{"PATH", "/nonexistent"};
  const TemporaryDirectory directory_;
  std::string room_;
  const fs::path truth_ = directory_.path() / "truth.csv", out_ = directory_.path() / "out";
};

const Words kBoth = {"--flip", "lamp", "--transparent", "pane"};

TEST_F(ChangedFaces, BelongToTheRequestOfATruthFile) {
  EXPECT_EQ(truth(kBoth).exit_code, 0);
  const std::string whole = text_of(truth_);
  const auto resume = [&](const Words& flags) {
    return with({"truth", room_, "--on", "floor", "--grid", "8x16", "--resume", "-o", truth_}, flags);
  };
  EXPECT_EQ(resume(kBoth).exit_code, 0);
  for (const Words& other : std::vector<Words>{
           {}, {"--flip", "lamp"}, {"--transparent", "pane"}, {"--flip", "lamp,floor", "--transparent", "pane"}}) {
    const Run refused = resume(other);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(refused.said("belongs to a different request")) << refused.error;
  }
  EXPECT_EQ(text_of(truth_), whole);
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
  EXPECT_EQ(json["findings"][0]["objects"], Words{"lamp"});
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
  const Words on = {"--at", "1.5", "1.5", "0", "--normal", "0", "0", "1", "--on", "floor"},
              grid = {"--on", "floor", "--grid", "3x3", "--force", "-o"};
  const auto with_all = [&](Words command, const Words& more) {
    command.insert(command.begin() + 1, covered);
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  std::vector<Words> commands = {with_all({"point", "--source", "lamp"}, on),
                                 with_all({"view"}, on),
                                 with_all({"truth"}, {grid.begin(), grid.end()}),
                                 with_all({"matrix", "--from", "floor", "--to", "lamp"}, {}),
                                 with_all({"radiosity", "--accuracy", "1e-2", "--force", "-o", file + ".csv"}, {}),
                                 with_all({"render", "--size", "4x4", "--force", "-o", file + ".exr"}, {}),
                                 with_all({"compare", "--no-methods", "--eps-b", ".1", "--rays", "1", "--seeds", "1",
                                           "--pattern", "jittered", "--variant", "mended"},
                                          grid)};
  for (Words& command : commands) {
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
