// exactff compare with several scenes, as users run it: files, messages, exit codes, interruptions.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "exactff/report.h"
#include "support/program.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::RunningProgram;
using validation::size_of;
using validation::text_of;

constexpr const char* kRoom =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\n"
    "v .4 .4 1\nv .7 .4 1\nv .7 .7 1\nv .4 .7 1\n"
    "g floor\nf 1 2 3 4\ng light\nf 8 7 6 5\ng plate\nf 9 10 11 12\n";

class StudyCommand : public testing::Test {
 protected:
  StudyCommand() {
    std::ofstream(directory_.path() / "room.obj") << kRoom;
    put("title Two rooms\n" + line("Room A", "4x4") + line("Room B", "3x3 --unless-abridged"));
  }

  void put(const std::string& study) const { std::ofstream(directory_.path() / "tiny.study") << study; }
  // A scene with few methods and little work; its files are beside the study file.
  static std::string line(const std::string& title, const std::string& grid_and_more) {
    return "scene room.obj --on floor --source light --title \"" + title +
           "\" --eps-b .1,.01 --rays 4 --seeds 1 --pattern jittered --variant mended --method exact "
           "--method hemicube:resolution=8|16|32 --method area-sampling:samples=1|4|16 --method-seeds 3 "
           "--method-receivers 4 --grid " +
           grid_and_more + '\n';
  }

  RunningProgram start(const fs::path& folder, std::vector<std::string> more = {}) const {
    std::vector<std::string> all{"compare", directory_.path() / "tiny.study", "-o", folder};
    all.insert(all.end(), more.begin(), more.end());
    // Figures take most of the time and are tested elsewhere.
    return {EXACTFF_PROGRAM, all, directory_.path() / "stderr", [] { ::setenv("PATH", "/nonexistent", 1); }};
  }
  int run(const fs::path& folder, const std::vector<std::string>& more = {}) const {
    const RunningProgram program = start(folder, more);
    const int code = program.wait();
    error_ = program.error();
    return code;
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

  const validation::TemporaryDirectory directory_;
  const fs::path out_ = directory_.path() / "out", journal_ = directory_.path() / "out.part";
  mutable std::string error_;
};

TEST_F(StudyCommand, WritesTheTablesOfEverySceneAndOneReport) {
  EXPECT_EQ(run(out_), 0) << error_;
  for (const char* file : {"room-a_values.csv", "room-b_values.csv", "room-a_methods.csv", "room-b_profile.csv",
                           "room-a_timings.csv", "report.html"}) {
    EXPECT_TRUE(fs::exists(out_ / file)) << file;
  }
  const std::string report = text_of(out_ / "report.html");
  for (const char* part : {"Two rooms", "id=\"scene-room-a\"", "id=\"scene-room-b\"", "Room A", "Room B"}) {
    EXPECT_NE(report.find(part), std::string::npos) << part;
  }
  EXPECT_FALSE(fs::exists(journal_));
  EXPECT_EQ(run(out_), 0) << "an earlier result may be replaced\n" << error_;
}

TEST_F(StudyCommand, LeavesScenesOutOfAnAbridgedReportAndSaysSo) {
  EXPECT_EQ(run(out_, {"--abridged"}), 0) << error_;
  EXPECT_TRUE(fs::exists(out_ / "room-a_values.csv"));
  EXPECT_FALSE(fs::exists(out_ / "room-b_values.csv"));
  const std::string report = text_of(out_ / "report.html");
  EXPECT_NE(report.find("Room B"), std::string::npos);
  EXPECT_NE(report.find("this report is abridged"), std::string::npos);
}

TEST_F(StudyCommand, HasTheSameValuesForAnyNumberOfThreads) {
  EXPECT_EQ(run(out_, {"--threads", "1"}), 0) << error_;
  EXPECT_EQ(run(directory_.path() / "two", {"--threads", "2"}), 0) << error_;
  EXPECT_EQ(values(out_).size(), 18U);
  EXPECT_TRUE(values(out_) == values(directory_.path() / "two"));
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
      EXPECT_EQ(running.error(), "exactff: interrupted; finished work is kept in " + journal_.string() +
                                     "; to continue, run the same command with --resume\n");
    }
  }
  EXPECT_EQ(run(out_), 2) << "neither --resume nor --force";
  EXPECT_TRUE(said("out.part: contains the finished work of an interrupted run")) << error_;
  EXPECT_EQ(run(out_, {"--resume", "--threads", "2"}), 0) << error_;
  EXPECT_TRUE(said("pieces of work were reused from the interrupted run")) << error_;
  EXPECT_FALSE(fs::exists(journal_));
  EXPECT_TRUE(values(out_) == values(directory_.path() / "whole"));
}

TEST_F(StudyCommand, TwiceAtOnceIsRefusedTheSecondTime) {
  put(line("Room A", "40x40"));
  const RunningProgram first = start(out_);
  while (size_of(journal_) < 5000 && !first.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(run(out_, {"--resume"}), 2);
  EXPECT_TRUE(said("another process is working on it")) << error_;
  first.send(SIGKILL);
  EXPECT_EQ(first.wait(), 128 + SIGKILL);
}

TEST_F(StudyCommand, RefusesFlagsOfASceneBesideTheFile) {
  EXPECT_EQ(run(out_, {"--on", "floor", "--grid", "2x2"}), 2);
  EXPECT_TRUE(said("flags of a scene are given with a study file: --on floor --grid 2x2")) << error_;
  EXPECT_FALSE(fs::exists(out_));
  EXPECT_FALSE(fs::exists(journal_));
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
      {"experiment karkanis-tims", "karkanis-times"},
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

TEST_F(StudyCommand, NamesTheNearestExperiment) {
  EXPECT_EQ(run(out_, {"--experiment", "closur"}), 2);
  EXPECT_TRUE(said("there is no experiment 'closur'")) << error_;
  EXPECT_TRUE(said("closure")) << error_;
}

TEST_F(StudyCommand, HasTheValuesOfTheLibraryCall) {
  EXPECT_EQ(run(out_), 0) << error_;
  const fs::path by_library = directory_.path() / "by-library";
  const validation::EnvironmentVariable without_gnuplot("PATH", "/nonexistent");
  study::Journal journal(study::journal_of_folder(by_library), study::Journal::Existing::kRefuse);
  const report::Outcome outcome =
      report::carry_out(report::read_study_file(directory_.path() / "tiny.study"), by_library, journal);
  EXPECT_EQ(values(by_library), values(out_));
  ASSERT_EQ(outcome.scenes.size(), 2U);
  EXPECT_EQ(outcome.scenes.front().title, "Room A");
  EXPECT_FALSE(outcome.scenes.front().sentences.empty());
  EXPECT_EQ(outcome.notes.size(), 1U) << "gnuplot is missing";
}

TEST_F(StudyCommand, OfNothingButLeftOutScenesIsRefused) {
  put(line("Room B", "3x3 --unless-abridged"));
  EXPECT_EQ(run(out_, {"--abridged"}), 2);
  EXPECT_TRUE(said("every scene of the study is left out")) << error_;
}

TEST_F(StudyCommand, RunsAnExperimentOnceHoweverOftenItIsNamed) {
  put("experiment closure closure\n");
  EXPECT_EQ(run(out_, {"--abridged", "--experiment", "closure"}), 0) << error_;
  const std::string report = text_of(out_ / "report.html");
  const std::size_t first = report.find("id=\"chapter-closure\"");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(report.find("id=\"chapter-closure\"", first + 1), std::string::npos);
  EXPECT_EQ(run(out_, {"--abridged"}), 0) << "an experiment's tables may be replaced\n" << error_;
}

}  // namespace
}  // namespace exactff
