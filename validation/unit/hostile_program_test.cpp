// The program in trouble: full disks, signals, little memory, a small stack, a broken gnuplot, output folders that are
// not folders. In every case the exit code is right and nothing half-written remains.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <functional>
#include <numbers>
#include <set>
#include <sstream>
#include <thread>

#include "support/program.h"
#include "unit/sanitized.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using Running = validation::RunningProgram;
using validation::TemporaryDirectory;

const std::string kRoom =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\n"
    "g floor\nf 1 2 3 4\ng light\nf 8 7 6 5\n";

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

class HostileProgram : public testing::Test {
 protected:
  HostileProgram() { fs::create_directory(place_); }

  Running start(
      const std::vector<std::string>& arguments, const std::function<void()>& prepare = [] {}) const {
    return {EXACTFF_PROGRAM, arguments, directory_.path() / "stderr", prepare};
  }

  std::vector<std::string> comparison(const fs::path& folder) const {
    return {"compare",   room_, "--on",         "floor",   "--source", "light", "--grid", "2x2",
            "--threads", "1",   "--no-methods", "--eps-b", ".1",       "-o",    folder};
  }
  std::vector<std::string> resumed(const fs::path& folder) const {
    std::vector<std::string> all = comparison(folder);
    all.emplace_back("--resume");
    return all;
  }
  std::vector<std::string> point(std::vector<std::string> more) const {
    std::vector<std::string> all{"point",    room_, "--at", ".5", ".5",       "0",
                                 "--normal", "0",   "0",    "1",  "--source", "light"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::vector<std::string> truth_file(const fs::path& file) const {
    return {"truth", room_, "--on", "floor", "--source", "light", "--grid", "2x2", "--threads", "1", "-o", file};
  }
  std::vector<std::vector<std::string>> printing() const;

  // A fake gnuplot that is found before any other.
  std::function<void()> with_gnuplot(const std::string& script) const {
    const fs::path folder = directory_.path() / "bin";
    fs::create_directory(folder);
    std::ofstream(folder / "gnuplot") << "#!/bin/sh\n" << script << '\n';
    fs::permissions(folder / "gnuplot", fs::perms::owner_all);
    return [path = folder.string() + ":/usr/bin:/bin"] { ::setenv("PATH", path.c_str(), 1); };
  }

  void expect_nothing_in_place() const { EXPECT_TRUE(fs::is_empty(place_)); }
  // Only the journal remains, and it is usable: with it, the comparison gives the bytes of an undisturbed one.
  void expect_only_a_journal(const fs::path& folder) const {
    EXPECT_EQ(names(folder.parent_path()), std::set<std::string>{folder.filename().string() + ".part"});
    const auto without_gnuplot = [] { ::setenv("PATH", "/nonexistent", 1); };
    const Running refused = start(comparison(folder), without_gnuplot);
    EXPECT_EQ(refused.wait(), 2);
    EXPECT_NE(refused.error().find(".part: contains the finished work of an interrupted run"), std::string::npos)
        << refused.error();
    const Running going_on = start(resumed(folder), without_gnuplot);
    EXPECT_EQ(going_on.wait(), 0) << going_on.error();
    EXPECT_NE(going_on.error().find("were reused from the interrupted run"), std::string::npos) << going_on.error();
    EXPECT_EQ(names(folder.parent_path()), std::set<std::string>{folder.filename().string()});
    fs::remove_all(directory_.path() / "undisturbed");
    EXPECT_EQ(start(comparison(directory_.path() / "undisturbed"), without_gnuplot).wait(), 0);
    for (const char* file : {"values.csv", "exact.csv", "summary.csv"}) {
      EXPECT_EQ(validation::text_of(folder / file), validation::text_of(directory_.path() / "undisturbed" / file));
    }
    fs::remove_all(folder);
  }
  static std::set<std::string> names(const fs::path& folder) {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder)) found.insert(entry.path().filename().string());
    return found;
  }

  const TemporaryDirectory directory_;
  const std::string room_ = directory_.write("room.obj", kRoom).string();
  const fs::path place_ = directory_.path() / "place";  // the place of the results
};

TEST_F(HostileProgram, AFullDiskLeavesTheJournalAlone) {
  for (const rlim_t bytes : {600, 2048}) {  // full while values are computed, and while tables are written
    const Running run = start(comparison(place_ / "result"), [bytes] { limit(RLIMIT_FSIZE, bytes); });
    EXPECT_EQ(run.wait(), 2);
    EXPECT_NE(run.error().find("cannot be written"), std::string::npos) << run.error();
    EXPECT_NE(run.error().find("result.part; to continue, run the same command with --resume"), std::string::npos);
    expect_only_a_journal(place_ / "result");
  }
}

TEST_F(HostileProgram, ADiskFullFromTheStartIsLeftAsItWas) {
  const Running run = start(comparison(place_ / "new" / "result"), [] { limit(RLIMIT_FSIZE, 10); });
  EXPECT_EQ(run.wait(), 2);
  expect_nothing_in_place();
}

TEST_F(HostileProgram, FoldersOnTheWayAreMade) {
  const Running run = start(comparison(place_ / "new" / "and" / "result"));
  EXPECT_EQ(run.wait(), 0) << run.error();
  EXPECT_EQ(names(place_ / "new" / "and"), std::set<std::string>{"result"});
}

TEST_F(HostileProgram, AFullDiskLeavesNoPicture) {
  const Running run = start(point({"--svg", place_ / "a.svg"}), [] { limit(RLIMIT_FSIZE, 512); });
  EXPECT_EQ(run.wait(), 2);
  EXPECT_NE(run.error().find("a.svg: cannot be written: File too large (nothing was written); "), std::string::npos);
  expect_nothing_in_place();
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

// Every command that prints.
std::vector<std::vector<std::string>> HostileProgram::printing() const {
  const std::string truth = (directory_.path() / "truth.csv").string();
  EXPECT_EQ(start(truth_file(truth)).wait(), 0);
  return {{"--help"},
          {"--version"},
          {"info", "--help"},
          {"compare", "--help"},
          {"info", "@"},
          {"info", "@", "--json"},
          {"info", room_},
          {"info", room_, "--json"},
          {"completion", "bash"},
          {"manual"},
          {"stress", "--list"},
          {"check", truth, truth},
          {"check", truth, truth, "--github"},
          truth_file(truth + ".2"),
          point({}),
          point({"--plain"}),
          point({"--json"})};
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
  EXPECT_EQ(names(place_), (std::set<std::string>{"a.csv", "b.csv", "c.svg"}));
}

// While gnuplot draws, the hidden folder exists: this is the worst moment for an interruption.
TEST_F(HostileProgram, SignalsWhileItWritesLeaveTheJournalAlone) {
  const fs::path started = directory_.path() / "started", folder = place_ / "result";
  const auto gnuplot = with_gnuplot("touch '" + started.string() + "'; exec sleep 100");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int times : {1, 2}) {
      fs::remove(started);
      const Running run = start(comparison(folder), gnuplot);
      while (!fs::exists(started) && !run.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      EXPECT_GT(names(place_).size(), 1U);
      for (int i = 0; i < times; ++i) run.send(signal);
      EXPECT_EQ(run.wait(), 128 + signal);
      EXPECT_TRUE(run.error().ends_with("\nexactff: interrupted; finished work is kept in " + folder.string() +
                                        ".part; to continue, run the same command with --resume\n"))
          << run.error();
      expect_only_a_journal(folder);
    }
  }
}

// One piece of work may take hours, such as a method with a billion rays.
TEST_F(HostileProgram, ASignalInAPieceOfWorkEndsItInHalfASecond) {
  const fs::path folder = place_ / "result";
  std::vector<std::string> arguments = comparison(folder);
  std::erase(arguments, "--no-methods");
  arguments.insert(arguments.end(), {"--sweep", "--method", "nettle:splits=4096,rays=65536", "--method-budget", "1e9"});
  const Running run = start(arguments);
  constexpr std::uintmax_t kFirstPiece = 200;  // bytes of the journal: its first line is shorter
  while (validation::size_of(folder.string() + ".part") < kFirstPiece && !run.has_ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  ASSERT_FALSE(run.has_ended()) << run.error();
  const auto sent = std::chrono::steady_clock::now();
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 128 + SIGINT);
  EXPECT_LT(std::chrono::steady_clock::now() - sent,
            std::chrono::seconds(kSanitized ? 10 : 2));  // the machine may be busy
  EXPECT_TRUE(run.error().ends_with("\nexactff: interrupted; finished work is kept in " + folder.string() +
                                    ".part; to continue, run the same command with --resume\n"))
      << run.error();
  EXPECT_FALSE(fs::exists(folder));
}

// A killed process cannot clean up. The next process does, but leaves the files of a living one alone.
TEST_F(HostileProgram, WhatAKilledRunLeavesTheNextClears) {
  const fs::path started = directory_.path() / "started", folder = place_ / "result";
  const auto gnuplot = with_gnuplot("touch '" + started.string() + "'; exec sleep 3");
  const auto begin = [&](const std::vector<std::string>& arguments) {
    fs::remove(started);
    const Running run = start(arguments, gnuplot);
    while (!fs::exists(started) && !run.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return run;
  };
  const Running killed = begin(comparison(folder));
  killed.send(SIGKILL);
  EXPECT_EQ(killed.wait(), 128 + SIGKILL);
  EXPECT_EQ(names(place_).size(), 2U);  // the journal, the hidden folder
  const Running stress = begin({"stress", "--family", "crack", "-o", folder});
  EXPECT_EQ(names(place_).size(), 2U);  // the journal, its own hidden folder
  const Running other = start(resumed(folder), [] { ::setenv("PATH", "/nonexistent", 1); });
  EXPECT_EQ(other.wait(), 0) << other.error();
  EXPECT_EQ(names(place_).size(), 2U);  // the result, and the hidden folder of the living process
  stress.send(SIGINT);
  EXPECT_EQ(stress.wait(), 128 + SIGINT);
  EXPECT_TRUE(stress.error().starts_with("exactff: interrupted; finished families: 1 of 1, kept in " +
                                         (place_ / "result.part" / "report.html").string() +
                                         "; --family runs single ones\n"))
      << stress.error() << "(what the other run wrote to this file may follow)";
  EXPECT_EQ(names(place_), (std::set<std::string>{"result", "result.part"}));
}

TEST_F(HostileProgram, ASignalWhileItReadsLeavesNothing) {
  const fs::path pipe = directory_.path() / "pipe.obj";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::vector<std::string> arguments = comparison(place_ / "a" / "result");
  arguments[1] = pipe;
  const Running run = start(arguments);
  std::ofstream writer(pipe);
  writer << kRoom << std::flush;  // it has started to read, and cannot end while the pipe is open
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 128 + SIGINT);
  expect_nothing_in_place();
}

TEST_F(HostileProgram, AnInterruptedRunIsBegunAnewByForce) {
  const fs::path folder = place_ / "result";
  EXPECT_EQ(start(comparison(folder), [] { limit(RLIMIT_FSIZE, 2048); }).wait(), 2);
  std::vector<std::string> arguments = comparison(folder);
  arguments.emplace_back("--force");
  const Running anew = start(arguments, [] { ::setenv("PATH", "/nonexistent", 1); });
  EXPECT_EQ(anew.wait(), 0);
  EXPECT_EQ(anew.error().find("were reused from"), std::string::npos) << anew.error();
  EXPECT_EQ(names(place_), std::set<std::string>{"result"});
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

TEST_F(HostileProgram, TheEndOfMemoryIsTold) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  std::string text;
  for (int i = 0; i < 4'000'000; ++i) text += "v 0 0 0\n";
  const std::string many = directory_.write("many.obj", text + kRoom).string();
  const Running run = start({"info", many}, [] { limit(RLIMIT_AS, 200 << 20); });
  EXPECT_EQ(run.wait(), 4);
  EXPECT_TRUE(run.error().starts_with("exactff: out of memory (")) << run.error();
}

// What a pair of patches remembers is limited, however many edges lie between them.
TEST_F(HostileProgram, AMatrixNeedsLittleMemoryWhateverLiesBetween) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  for (const char* scene : {"@soup:n=3000,cover=3", "@tiles:n=40"}) {
    const Running run =
        start({"matrix", scene, "--from", "floor", "--to", "source", "--budget", "30", "--threads", "1", "--plain"},
              [] { limit(RLIMIT_AS, 400 << 20); });
    EXPECT_EQ(run.wait(), 0) << scene << '\n' << run.error();
  }
}

// With coordinates so far apart, only the exact numbers need much memory; GMP itself would abort.
TEST_F(HostileProgram, TheEndOfMemoryIsToldByExactNumbersToo) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  constexpr int kCorners = 2000;
  std::ostringstream text;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    text << "v " << 1e300 * std::cos(angle) << ' ' << 1e300 * std::sin(angle) << ' ' << 1e-300 * (1 + i % 7) << '\n';
  }
  text << 'f';
  for (int i = 1; i <= kCorners; ++i) text << ' ' << i;
  const std::string wide = directory_.write("wide.obj", text.str() + '\n').string();
  int told = 0;
  for (rlim_t megabytes = 60; megabytes <= 110; megabytes += 2) {
    const auto little_memory = [megabytes] { limit(RLIMIT_AS, megabytes << 20); };
    if (start({"--version"}, little_memory).wait() != 0) continue;  // not even the libraries can be loaded
    const int code = start({"info", wide}, little_memory).wait();
    EXPECT_TRUE(code == 0 || code == 4) << megabytes << " MB: " << code;
    if (code == 4) ++told;
  }
  EXPECT_GT(told, 0);
}

// Memory runs out at some point before main(), in it or in a thread. The program ends with one of its exit codes, or
// the loader's if it cannot map the libraries, but never by a signal.
class LittleMemory : public HostileProgram, public testing::WithParamInterface<const char*> {
 protected:
  std::vector<std::string> arguments() const {
    const std::string command = GetParam();
    if (command == "info") return {"info", room_};
    if (command == "point") return point({});
    if (command == "compare") return comparison(place_ / "result");
    std::vector<std::string> truth = truth_file(place_ / "truth.csv");
    *(std::ranges::find(truth, "--threads") + 1) = "2";
    return truth;
  }

  bool works_with(rlim_t kilobytes) const {
    const Running run = start(arguments(), [kilobytes] {
      limit(RLIMIT_AS, kilobytes << 10);
      ::setenv("PATH", "/nonexistent", 1);  // without gnuplot, which has its own limits
    });
    const int code = run.wait();
    const bool loaded = code != 127;
    EXPECT_TRUE(code == 0 || code == 4 || !loaded) << kilobytes << " kB: " << code << '\n' << run.error();
    EXPECT_EQ(code == 0 || !run.error().empty(), true) << kilobytes << " kB";
    EXPECT_TRUE(code != 4 || run.error().find("exactff: ") != std::string::npos) << run.error();
    fs::remove_all(place_);
    fs::create_directory(place_);
    return code == 0;
  }
};

TEST_P(LittleMemory, EndsItByNoSignal) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  constexpr rlim_t kFine = 512;
  rlim_t fails = 20'000, works = 600'000;
  EXPECT_FALSE(works_with(fails));
  EXPECT_TRUE(works_with(works));
  while (works - fails > kFine) {
    const rlim_t middle = (fails + works) / 2;
    (works_with(middle) ? works : fails) = middle;
  }
  for (rlim_t less = kFine; less <= 24 * kFine; less += kFine) (void)works_with(works - less);
  for (rlim_t more = 1; more <= 4; ++more) (void)works_with(works + more * 10 * kFine);
}
INSTANTIATE_TEST_SUITE_P(All, LittleMemory, testing::Values("info", "point", "truth", "compare"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(HostileProgram, ASmallStackIsEnough) {
  if (kSanitized) GTEST_SKIP() << "sanitized code needs a large stack";
  constexpr int kTeeth = 10'000;
  std::string text = "v 0 -1 0\nv " + std::to_string(kTeeth) + " -1 0\n", face = "g comb\nf 1 2";
  for (int i = kTeeth; i-- > 0;) {
    const std::string x = std::to_string(i);
    text += "v " + x + ".5 1000 " + (i % 2 == 0 ? "0" : ".1") + "\nv " + x + " 0 0\n";
    const int next = 2 * (kTeeth - i) + 1;
    face += ' ' + std::to_string(next) + ' ' + std::to_string(next + 1);
  }
  const std::string comb =
      directory_.write("comb.obj", text + face + "\ng light\nv 0 0 9\nv 1 0 9\nv 0 1 9\nf -1 -2 -3\n").string();
  const Running run =
      start({"point", comb, "--at", "0", "0", "5", "--normal", "0", "0", "1", "--source", "light", "--plain"},
            [] { limit(RLIMIT_STACK, 256 << 10); });
  EXPECT_EQ(run.wait(), 0) << run.error();
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
      {"..", "is the current folder"},
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

TEST_F(HostileProgram, SenselessFlagsAreRefused) {
  const std::vector<std::string> table[] = {
      {"--grid", "0x0"},  {"--grid", "-1x5"},  {"--grid", "1e9x1e9"}, {"--grid", "1000000000x1000000000"},
      {"--grid", ""},     {"--grid", "3x4x5"}, {"--rays", "0"},       {"--rays", "2147483647"},
      {"--eps-b", "nan"}, {"--eps-b", "-1"},   {"--eps-b", "1,,2"},   {"--threads", "0"},
      {"--source", "x"},  {"--pattern", "?"},
  };
  for (const std::vector<std::string>& flags : table) {
    std::vector<std::string> arguments = comparison(place_ / "result");
    const auto place = std::find(arguments.begin(), arguments.end(), flags[0]);
    if (place != arguments.end()) {
      *(place + 1) = flags[1];
    } else {
      arguments.insert(arguments.end(), flags.begin(), flags.end());
    }
    const Running run = start(arguments);
    EXPECT_EQ(run.wait(), 2) << flags[0] << ' ' << flags[1];
    EXPECT_FALSE(run.error().empty());
    expect_nothing_in_place();
  }
  for (const std::vector<std::string>& flags : std::vector<std::vector<std::string>>{{"--digits", "1000000000"},
                                                                                     {"--eps-b", "nan"},
                                                                                     {"--eps-a", "-1"},
                                                                                     {"--reflectance", "nan"},
                                                                                     {"--rays", "0"}}) {
    EXPECT_EQ(start(point(flags)).wait(), 2) << flags[0];
  }
}

TEST_F(HostileProgram, AReceiverFarFromItsFaceIsWarnedAbout) {
  const Running far =
      start({"point", room_, "--at", "5", "5", "1", "--normal", "0", "0", "1", "--on", "floor", "--source", "light"});
  EXPECT_EQ(far.wait(), 0);
  EXPECT_NE(far.error().find("of the size of face 'floor' away from that face"), std::string::npos);
  const Running near = start(point({"--on", "floor"}));
  EXPECT_EQ(near.wait(), 0);
  EXPECT_EQ(near.error(), "");
}

}  // namespace
}  // namespace exactff
