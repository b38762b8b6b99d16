// exactff compare with several scenes, as users run it: files, messages, exit codes, interruptions.
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kThreeSquares =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\n"
    "v .4 .4 1\nv .7 .4 1\nv .7 .7 1\nv .4 .7 1\n"
    "g floor\nf 1 2 3 4\ng light\nf 8 7 6 5\ng plate\nf 9 10 11 12\n";

class StudyCommand : public testing::Test {
 protected:
  StudyCommand() {
    std::ofstream(directory_.path() / "room.obj") << kThreeSquares;
    put("title Two rooms\n" + line("Room A", "4x4") + line("Room B", "3x3"));
  }

  void put(const std::string& study) const { std::ofstream(directory_.path() / "tiny.study") << study; }
  // A scene with few methods and little work; its files are beside the study file.
  static std::string line(const std::string& title, const std::string& grid_and_more) {
    return "scene room.obj --on floor --source light --title \"" + title +
           "\" --eps-b .1,.01 --rays 4 --seeds 1 --pattern jittered --variant mended --sweep --method exact "
           "--method hemicube:resolution=8|16|32 --method area-sampling:samples=1|4|16 --method-seeds 3 "
           "--method-receivers 4 --grid " +
           grid_and_more + '\n';
  }

  RunningProgram start(const fs::path& folder, Words more = {}) const {
    return {EXACTFF_PROGRAM, joined({"compare", directory_.path() / "tiny.study", "-o", folder}, more),
            directory_.path() / "stderr"};
  }
  int run(const fs::path& folder, const Words& more = {}) const {
    return run(joined({"compare", directory_.path() / "tiny.study", "-o", folder}, more));
  }
  int run(const Words& all) const {
    const ProgramRun run = run_exactff(all);
    output_ = run.output;
    error_ = run.error;
    return run.exit_code;
  }
  bool said(const std::string& part) const { return error_.find(part) != std::string::npos; }

  // The files with values, by name.
  static std::map<std::string, std::string> values(const fs::path& folder) {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename();
      if (name.ends_with(".csv") && name.find("timings") == std::string::npos) found[name] = text_of(entry.path());
    }
    return found;
  }

  // Figures take most of the time and are tested elsewhere.
  const EnvironmentVariable without_gnuplot_{"PATH", "/nonexistent"};
  const TemporaryDirectory directory_;
  const fs::path out_ = directory_.path() / "out", journal_ = directory_.path() / "out.part";
  mutable std::string output_, error_;
};

TEST_F(StudyCommand, WritesTheTablesOfEverySceneAndOneReport) {
  EXPECT_EQ(run(out_), 0) << error_;
  for (const char* file : {"room-a_values.csv", "room-b_values.csv", "room-a_methods.csv", "room-b_profile.csv",
                           "room-a_timings.csv", "report.html"}) {
    EXPECT_TRUE(fs::exists(out_ / file)) << file;
  }
  const std::string report = text_of(out_ / "report.html");
  for (const char* part : {"Two rooms", "id=\"scene-room-a\"", "id=\"scene-room-b\"", "Room A", "Room B"}) {
    EXPECT_HOLDS(report, part) << part;
  }
  EXPECT_FALSE(fs::exists(journal_));
}

// As truth treats a file.
TEST_F(StudyCommand, AFinishedFolderIsNotReplacedByAccident) {
  put(line("Room A", "3x3"));
  EXPECT_EQ(run(out_), 0) << error_;
  const auto made = fs::last_write_time(out_ / "report.html");
  EXPECT_EQ(run(out_), 2);
  EXPECT_TRUE(said("out: holds a finished report (a finished result is not replaced by accident); ")) << error_;
  EXPECT_EQ(run(out_, {"--resume", "--threads", "1"}), 0) << error_;
  EXPECT_EQ(fs::last_write_time(out_ / "report.html"), made);
  EXPECT_FALSE(fs::exists(journal_));
  EXPECT_EQ(run(out_, {"--force"}), 0) << error_;
  EXPECT_NE(fs::last_write_time(out_ / "report.html"), made);
}

TEST_F(StudyCommand, ResumeLeavesTheResultOfAnotherRequestAlone) {
  put(line("Room A", "3x3"));
  EXPECT_EQ(run(out_), 0) << error_;
  const std::string before = text_of(out_ / "report.html");
  const std::string one = line("Room A", "3x3");
  const Words others = {line("Room A", "3x4"), line("Room B", "3x3"), "title Other\n" + one,
                        one.substr(0, one.size() - 1) + " --method wallace\n",
                        one.substr(0, one.size() - 1) + " --method-budget 3\n"};
  for (const std::string& other : others) {
    put(other);
    EXPECT_EQ(run(out_, {"--resume"}), 2) << other;
    EXPECT_TRUE(said("out: holds the finished report of another request, or of another version of exactff")) << error_;
  }
  put(one);
  std::ofstream(directory_.path() / "room.obj", std::ios::app) << "v 3 3 3\nv 4 3 3\nv 3 4 3\ng more\nf 13 14 15\n";
  EXPECT_EQ(run(out_, {"--resume"}), 2) << "another scene under the same name";
  EXPECT_EQ(text_of(out_ / "report.html"), before);
  EXPECT_FALSE(fs::exists(journal_));
}

// --- compare --method X is about X ---

class NamedMethods : public StudyCommand {
 protected:
  std::string output(const Words& more) const {
    code_ = run(joined(
        {"compare", directory_.path() / "room.obj", "--on", "floor", "--grid", "4x4", "--source", "light", "-o", out_},
        more));
    return output_;
  }
  mutable int code_ = -1;
};

TEST_F(NamedMethods, OneSettingIsComparedWithTheExactValues) {
  const std::string said = output({"--method", "hemicube:resolution=64"});
  EXPECT_EQ(code_, 0) << error_;
  EXPECT_HOLDS(said, "hemicube, resolution 64: RMS error ");
  EXPECT_HOLDS(said, " times as long as the exact method (at ");
  EXPECT_HOLDS(said, "The exact form factor takes ");
  for (const char* part : {"base setting", "Ray sampling", "tolerance"}) {
    EXPECT_EQ(said.find(part), std::string::npos) << part << '\n' << said;
  }
  for (const char* file : {"exact.csv", "methods.csv", "timings.csv", "method_timings.csv"}) {
    EXPECT_TRUE(fs::exists(out_ / file)) << file;
  }
  for (const char* file : {"values.csv", "summary.csv", "summary_timings.csv"})
    EXPECT_FALSE(fs::exists(out_ / file)) << file;
  const std::string methods = text_of(out_ / "methods.csv");
  EXPECT_HOLDS(methods, "\nexact,");
  EXPECT_HOLDS(methods, "\nhemicube,");
  EXPECT_EQ(methods.find("eps_b"), std::string::npos) << methods;
  const std::string page = text_of(out_ / "report.html");
  EXPECT_HOLDS(page, "<p class=\"verdict\">Use the exact method");
  EXPECT_HOLDS(page, "hemicube, resolution 64.</strong>") << "the pictures show it";
  EXPECT_HOLDS(page, "the comparison is about named methods (--sweep runs it, too)");
  EXPECT_EQ(page.find("Tampieri’s algorithm: tolerance and error"), std::string::npos);
}

TEST_F(NamedMethods, OptionsWithoutEffectAreRefused) {
  (void)output({"--method", "wallace", "--eps-b", ".1", "--sweep-budget", "1"});
  EXPECT_EQ(code_, 2);
  EXPECT_TRUE(said("--eps-b and --sweep-budget have no effect beside --method (")) << error_;
  (void)output({"--method", "hemicube", "--method-seeds", "3"});
  EXPECT_EQ(code_, 2);
  EXPECT_TRUE(said("--method-seeds has no effect here (none of the named methods uses random numbers)")) << error_;
  EXPECT_EQ(run("-"), 2);
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(StudyCommand, InterruptedAndResumedHasTheSameValues) {
  put(line("Room A", "40x40") + line("Room B", "4x4"));
  EXPECT_EQ(run(directory_.path() / "whole"), 0) << error_;
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const std::uintmax_t before = size_of(journal_);
    const RunningProgram running = start(out_, {"--resume"});
    while (size_of(journal_) <= before + 5000 && !running.has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    running.send(signal);
    ASSERT_EQ(running.wait(), 128 + signal);
    ASSERT_GT(size_of(journal_), before);
    EXPECT_FALSE(fs::exists(out_));
    if (signal != SIGKILL) {
      EXPECT_TRUE(running.error().ends_with("\nexactff: interrupted; finished work is kept in " + journal_.string() +
                                            "; to continue, run the same command with --resume\n"))
          << running.error();
    }
  }
  EXPECT_EQ(run(out_), 2) << "neither --resume nor --force";
  EXPECT_TRUE(said("out.part: contains the finished work of an interrupted run")) << error_;
  EXPECT_EQ(run(out_, {"--resume", "--threads", "2"}), 0) << error_;
  EXPECT_TRUE(said("pieces of work were reused from the interrupted run")) << error_;
  EXPECT_FALSE(fs::exists(journal_));
  EXPECT_TRUE(values(out_) == values(directory_.path() / "whole"));
}

TEST_F(StudyCommand, NamesTheLineThatIsWrong) {
  const std::pair<std::string, std::string> table[] = {
      {"scene room.obj --on floor --grid 2x2 --gird 3x3", "--gird"},
      {"scene missing.obj --on floor --grid 2x2", "missing.obj"},
      {"scene room.obj --on ceiling --grid 2x2 --source light", "ceiling"},
      {"scene room.obj --on floor --grid 2x2 --source nobody", "nobody"},
      {"scene room.obj --on floor --grid 2x2 --source light --method hemicub", "hemicub"},
      {"scene room.obj --on floor --grid 2x2 --source light --eps-b nan", "--eps-b"},
      {"scene room.obj --source light", "--on"},
      {"scene --on floor --grid 2x2", "SCENE"},
      {"scene @teapott --on floor --grid 2x2", "teapot"},
  };
  for (const auto& [wrong, named] : table) {
    put("title Two rooms\n\n" + wrong + '\n');
    EXPECT_EQ(run(out_), 2) << wrong;
    EXPECT_TRUE(said("tiny.study:3: ")) << wrong << '\n' << error_;
    EXPECT_TRUE(said(named)) << wrong << '\n' << error_;
  }
  EXPECT_FALSE(fs::exists(out_));
  EXPECT_FALSE(fs::exists(journal_));
}

}  // namespace
}  // namespace exactff
