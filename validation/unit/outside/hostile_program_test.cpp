// The program in trouble: full disks, closed streams, a broken gnuplot, output folders that are not folders, senseless
// flags. In every case the exit code is right and nothing half-written remains.
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <thread>

#include "support/test.h"
#include "unit/outside/sanitized.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

class HostileProgram : public testing::Test {
 protected:
  using Running = RunningProgram;

  static inline const std::string kRoom =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\n"
      "g floor\nf 1 2 3 4\ng light\nf 8 7 6 5\n";

  HostileProgram() { fs::create_directory(place_); }

  static void limit(int resource, rlim_t value) {
    const rlimit both{value, value};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
  }

  Running start(
      const Words& arguments, const std::function<void()>& prepare = [] {}) const {
    return {EXACTFF_PROGRAM, arguments, directory_.path() / "stderr", prepare};
  }

  Words comparison(const fs::path& folder) const {
    return {"compare",   room_, "--on",         "floor",   "--source", "light", "--grid", "2x2",
            "--threads", "1",   "--no-methods", "--eps-b", ".1",       "-o",    folder};
  }
  Words resumed(const fs::path& folder) const {
    Words all = comparison(folder);
    all.emplace_back("--resume");
    return all;
  }
  Words point(const Words& more) const {
    return joined({"point", room_, "--at", ".5", ".5", "0", "--normal", "0", "0", "1", "--source", "light"}, more);
  }

  Words truth_file(const fs::path& file) const {
    return {"truth", room_, "--on", "floor", "--source", "light", "--grid", "2x2", "--threads", "1", "-o", file};
  }
  // Every command that prints.
  std::vector<Words> printing() const {
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
            {"stress", "--list"},
            {"check", truth, truth},
            {"check", truth, truth, "--github"},
            truth_file(truth + ".2"),
            point({}),
            point({"--plain"}),
            point({"--json"})};
  }

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
    EXPECT_EQ(names_in(folder.parent_path()), std::set<std::string>{folder.filename().string() + ".part"});
    const auto without_gnuplot = [] { ::setenv("PATH", "/nonexistent", 1); };
    const Running refused = start(comparison(folder), without_gnuplot);
    EXPECT_EQ(refused.wait(), 2);
    EXPECT_HOLDS(refused.error(), ".part: contains the finished work of an interrupted run");
    const Running going_on = start(resumed(folder), without_gnuplot);
    EXPECT_EQ(going_on.wait(), 0) << going_on.error();
    EXPECT_HOLDS(going_on.error(), "were reused from the interrupted run");
    EXPECT_EQ(names_in(folder.parent_path()), std::set<std::string>{folder.filename().string()});
    fs::remove_all(directory_.path() / "undisturbed");
    EXPECT_EQ(start(comparison(directory_.path() / "undisturbed"), without_gnuplot).wait(), 0);
    for (const char* file : {"values.csv", "exact.csv", "summary.csv"}) {
      EXPECT_EQ(text_of(folder / file), text_of(directory_.path() / "undisturbed" / file));
    }
    fs::remove_all(folder);
  }

  const TemporaryDirectory directory_;
  const std::string room_ = directory_.write("room.obj", kRoom).string();
  const fs::path place_ = directory_.path() / "place";  // the place of the results
};

TEST_F(HostileProgram, AFullDiskLeavesTheJournalAlone) {
  for (const rlim_t bytes : {600, 2048}) {  // full while values are computed, and while tables are written
    const Running run = start(comparison(place_ / "result"), [bytes] { limit(RLIMIT_FSIZE, bytes); });
    EXPECT_EQ(run.wait(), 2);
    EXPECT_HOLDS(run.error(), "cannot be written");
    EXPECT_HOLDS(run.error(), "result.part; to continue, run the same command with --resume");
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
      EXPECT_HOLDS(run.error(),
                   "the result could not be written to standard output (the printed output is incomplete)");
    }
  }
}

// As usual on Unix: if a pager is closed early, this is not an error, but nothing more can be printed.
TEST_F(HostileProgram, APipeThatNobodyReadsEndsItAsItEndsOthers) {
  const auto ignoring = [] {
    std::signal(SIGPIPE, SIG_IGN);
    to_a_pipe_without_reader();
  };
  for (const auto& arguments : {Words{"--help"}, {"info", room_}, point({"--json"})}) {
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
  EXPECT_EQ(text_of(place_ / "b.csv"), text_of(place_ / "a.csv"));
  EXPECT_TRUE(text_of(place_ / "c.svg").ends_with("</svg>\n"));
  EXPECT_EQ(names_in(place_), (std::set<std::string>{"a.csv", "b.csv", "c.svg"}));
}

TEST_F(HostileProgram, WithoutAWorkingGnuplotTheTablesAreComplete) {
  const Running failing = start(comparison(place_ / "a"), with_gnuplot("echo no such luck >&2; exit 1"));
  EXPECT_EQ(failing.wait(), 0);
  EXPECT_HOLDS(failing.error(), "no such luck");
  const Running missing = start(comparison(place_ / "b"), [] { ::setenv("PATH", "/nonexistent", 1); });
  EXPECT_EQ(missing.wait(), 0);
  EXPECT_HOLDS(missing.error(), "gnuplot was not found");
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
    EXPECT_HOLDS(run.error(), message);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(place_), fs::directory_iterator()), 4);
  EXPECT_TRUE(fs::exists(place_ / "foreign" / "letter.txt"));
}

TEST_F(HostileProgram, FoldersMadeOnTheWayDisappearWithARefusal) {
  Words arguments = comparison(place_ / "a" / "b" / "c");
  arguments[5] = "nobody";  // --source
  EXPECT_EQ(start(arguments).wait(), 2);
  expect_nothing_in_place();
}

// --- signals, and what killed and interrupted runs leave to the next one ---

// While gnuplot draws, the hidden folder exists: this is the worst moment for an interruption.
TEST_F(HostileProgram, SignalsWhileItWritesLeaveTheJournalAlone) {
  const fs::path started = directory_.path() / "started", folder = place_ / "result";
  const auto gnuplot = with_gnuplot("touch '" + started.string() + "'; exec sleep 100");
  for (const auto& [signal, times] : {std::pair(SIGINT, 1), {SIGTERM, 2}, {SIGHUP, 1}}) {
    fs::remove(started);
    const Running run = start(comparison(folder), gnuplot);
    while (!fs::exists(started) && !run.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_GT(names_in(place_).size(), 1U);
    for (int i = 0; i < times; ++i) run.send(signal);
    EXPECT_EQ(run.wait(), 128 + signal);
    EXPECT_TRUE(run.error().ends_with("\nexactff: interrupted; finished work is kept in " + folder.string() +
                                      ".part; to continue, run the same command with --resume\n"))
        << run.error();
    expect_only_a_journal(folder);
  }
}

// --- The program with little memory or a small stack: it says so or needs no more, and never ends by a signal ---

// What a pair of patches remembers is limited, however many edges lie between them.
TEST_F(HostileProgram, AMatrixNeedsLittleMemoryWhateverLiesBetween) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  for (const char* scene : {"@soup:n=3000,cover=3", "@tiles:n=40"}) {
    const Running run =
        start({"matrix", scene, "--from", "floor", "--to", "source", "--budget", "30", "--threads", "1", "--plain"},
              [] { limit(RLIMIT_AS, 400 << 20); });
    const int code = run.wait();
    EXPECT_TRUE(code == 0 || code == 3) << scene << '\n' << run.error();  // 3: wider than asked
  }
}

// With coordinates so far apart, only the exact numbers need much memory; GMP itself would abort.
TEST_F(HostileProgram, TheEndOfMemoryIsToldByExactNumbersToo) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  constexpr int kCorners = 1400;
  std::ostringstream text;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    text << "v " << 1e300 * std::cos(angle) << ' ' << 1e300 * std::sin(angle) << ' ' << 1e-300 * (1 + i % 7) << '\n';
  }
  text << 'f';
  for (int i = 1; i <= kCorners; ++i) text << ' ' << i;
  const std::string wide = directory_.write("wide.obj", text.str() + '\n').string();
  int told = 0;
  for (rlim_t megabytes = 60; megabytes <= 110; ++megabytes) {
    const auto little_memory = [megabytes] { limit(RLIMIT_AS, megabytes << 20); };
    if (start({"--version"}, little_memory).wait() != 0) continue;  // not even the libraries can be loaded
    const int code = start({"info", wide}, little_memory).wait();
    EXPECT_TRUE(code == 0 || code == 4) << megabytes << " MB: " << code;
    if (code == 0) break;  // and so it is with more
    ++told;
  }
  EXPECT_GT(told, 0);
}

// Memory runs out at some point before main(), in it or in a thread. The program ends with one of its exit codes, or
// the loader's if it cannot map the libraries, but never by a signal.
class LittleMemory : public HostileProgram, public testing::WithParamInterface<const char*> {
 protected:
  Words arguments() const {
    const std::string command = GetParam();
    if (command == "info") return {"info", room_};
    if (command == "point") return point({});
    if (command == "compare") return comparison(place_ / "result");
    Words truth = truth_file(place_ / "truth.csv");
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
  for (rlim_t less = kFine; less <= 24 * kFine; less += 2 * kFine) (void)works_with(works - less);
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

}  // namespace
}  // namespace exactff
