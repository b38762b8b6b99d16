// The program in trouble: full disks, closed streams, a broken gnuplot, output folders that are not folders, senseless
// flags. In every case the exit code is right and nothing half-written remains.
#include "unit/outside/hostile_program.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/folder.h"
#include "support/program.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::names_in;

TEST_F(HostileProgram, AFullDiskLeavesTheJournalAlone) {
  for (const rlim_t bytes : {600, 2048}) {  // full while values are computed, and while tables are written
    const Running run = start(comparison(place_ / "result"), [bytes] { limit(RLIMIT_FSIZE, bytes); });
    EXPECT_EQ(run.wait(), 2);
    EXPECT_NE(run.error().find("cannot be written"), std::string::npos) << run.error();
    EXPECT_NE(run.error().find("result.part; to continue, run the same command with --resume"), std::string::npos);
    expect_only_a_journal(place_ / "result");
  }
}

void to_a_full_disk() {
  if (std::freopen("/dev/full", "w", stdout) == nullptr) ::_exit(125);
}
void to_nowhere() { ::close(STDOUT_FILENO); }
void to_a_pipe_without_reader() {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0 || ::dup2(ends[1], STDOUT_FILENO) < 0) ::_exit(125);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(HostileProgram, AFullDiskOrNoPlaceAsStandardOutputIsAnError) {
  for (const auto& arguments : printing()) {
    for (const auto& stdout_of : {to_a_full_disk, to_nowhere}) {
      fs::remove(directory_.path() / "truth.csv.2");
      const Running run = start(arguments, stdout_of);
      EXPECT_EQ(run.wait(), 2) << arguments[0] << ' ' << arguments.back();
      EXPECT_NE(
          run.error().find("the result could not be written to standard output (the printed output is incomplete)"),
          std::string::npos)
          << run.error();
    }
  }
}

// As usual on Unix: if a pager is closed early, this is not an error, but nothing more can be printed.
TEST_F(HostileProgram, APipeThatNobodyReadsEndsItAsItEndsOthers) {
  const auto ignoring = [] {
    std::signal(SIGPIPE, SIG_IGN);
    to_a_pipe_without_reader();
  };
  for (const auto& arguments : {std::vector<std::string>{"--help"}, {"info", room_}, point({"--json"})}) {
    EXPECT_EQ(start(arguments, to_a_pipe_without_reader).wait(), 128 + SIGPIPE);
    EXPECT_EQ(start(arguments, ignoring).wait(), 2);
  }
}

// Otherwise the file could get the descriptor of standard output and receive the printed text.
TEST_F(HostileProgram, WithoutStandardStreamsFilesHoldWhatTheyShould) {
  EXPECT_EQ(start(truth_file(place_ / "a.csv")).wait(), 0);
  const auto all_closed = [] {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::close(stream);
  };
  EXPECT_EQ(start(truth_file(place_ / "b.csv"), all_closed).wait(), 2);
  EXPECT_EQ(start(point({"--svg", place_ / "c.svg"}), all_closed).wait(), 2);
  EXPECT_EQ(validation::text_of(place_ / "b.csv"), validation::text_of(place_ / "a.csv"));
  EXPECT_TRUE(validation::text_of(place_ / "c.svg").ends_with("</svg>\n"));
  EXPECT_EQ(names_in(place_), (std::set<std::string>{"a.csv", "b.csv", "c.svg"}));
}

TEST_F(HostileProgram, AFileWhereTheJournalWouldBeIsNotLost) {
  std::ofstream(place_ / "result.part") << "dear diary";
  for (const std::string flag : {"", "--resume", "--force"}) {
    std::vector<std::string> arguments = comparison(place_ / "result");
    if (!flag.empty()) arguments.push_back(flag);
    const Running run = start(arguments);
    EXPECT_EQ(run.wait(), 2);
    EXPECT_NE(run.error().find("result.part: already exists, and exactff did not write it"), std::string::npos);
    EXPECT_EQ(validation::text_of(place_ / "result.part"), "dear diary");
  }
}

TEST_F(HostileProgram, WithoutAWorkingGnuplotTheTablesAreComplete) {
  const Running failing = start(comparison(place_ / "a"), with_gnuplot("echo no such luck >&2; exit 1"));
  EXPECT_EQ(failing.wait(), 0);
  EXPECT_NE(failing.error().find("no such luck"), std::string::npos);
  const Running missing = start(comparison(place_ / "b"), [] { ::setenv("PATH", "/nonexistent", 1); });
  EXPECT_EQ(missing.wait(), 0);
  EXPECT_NE(missing.error().find("gnuplot was not found"), std::string::npos);
  for (const char* folder : {"a", "b"}) {
    EXPECT_TRUE(fs::exists(place_ / folder / "values.csv"));
    EXPECT_TRUE(fs::exists(place_ / folder / "report.html"));
  }
}

TEST_F(HostileProgram, FoldersThatMustNotBeReplacedAreNot) {
  fs::create_directory(place_ / "foreign");
  std::ofstream(place_ / "foreign" / "letter.txt") << "dear";
  std::ofstream(place_ / "file") << "not a folder";
  fs::create_directory(place_ / "real");
  fs::create_directory_symlink("real", place_ / "link");
  const std::pair<std::string, std::string> table[] = {
      {"foreign", "the folder holds 'letter.txt', which exactff did not write"},
      {"file", "is not a folder"},
      {"file/below", "is not a folder that can be written to"},
      {"link", "is a symbolic link"},
      {std::string(250, 'n'), "File name too long"},
      {".", "is the current folder"},
      {"..", "lies in the folder of the result"},  // the scene
      {"", "the name of the output folder is empty"},
  };
  for (const auto& [folder, message] : table) {
    const Running run = start(comparison(folder), [this] {
      if (::chdir(place_.c_str()) != 0) ::_exit(125);
    });
    EXPECT_EQ(run.wait(), 2) << folder;
    EXPECT_NE(run.error().find(message), std::string::npos) << run.error();
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(place_), fs::directory_iterator()), 4);
  EXPECT_TRUE(fs::exists(place_ / "foreign" / "letter.txt"));
}

TEST_F(HostileProgram, FoldersMadeOnTheWayDisappearWithARefusal) {
  std::vector<std::string> arguments = comparison(place_ / "a" / "b" / "c");
  arguments[5] = "nobody";  // --source
  EXPECT_EQ(start(arguments).wait(), 2);
  expect_nothing_in_place();
}

TEST_F(HostileProgram, APictureGoesWhereALinkLeads) {
  fs::create_symlink("target.svg", place_ / "link.svg");
  for (int i = 0; i < 2; ++i) {  // at first the target does not exist
    EXPECT_EQ(start(point({"--svg", place_ / "link.svg"})).wait(), 0);
    EXPECT_TRUE(fs::is_symlink(place_ / "link.svg"));
    EXPECT_GT(fs::file_size(place_ / "target.svg"), 100U);
  }
}

}  // namespace
}  // namespace exactff
