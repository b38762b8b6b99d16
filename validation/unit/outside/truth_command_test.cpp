// exactff truth and exactff merge as scripts run them: killed, interrupted, on full disks, twice at once.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "support/program.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::ProgramRun;
using validation::RunningProgram;
using validation::size_of;
using validation::text_of;

class TruthCommand : public testing::Test {
 protected:
  std::vector<std::string> truth(const std::string& grid, const fs::path& file, std::vector<std::string> more) const {
    std::vector<std::string> all{"truth", kScene, "--on", "floor", "--grid", grid, "-o", file};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ProgramRun run(const std::string& grid, const fs::path& file, const std::vector<std::string>& more = {}) const {
    return validation::run_program(EXACTFF_PROGRAM, truth(grid, file, more));
  }
  RunningProgram start(
      const std::string& grid, const std::vector<std::string>& more,
      const std::function<void()>& prepare = [] {}) const {
    return {EXACTFF_PROGRAM, truth(grid, file_, more), directory_.path() / "stderr", prepare};
  }
  // The Boolean engine is slow, which gives the test time, and it gives the same bytes.
  RunningProgram start_slowly(std::vector<std::string> more) const {
    more.insert(more.end(), {"--engine", "boolean", "--threads", "2"});
    return start(kGrid, more);
  }
  // Waits until rows have been added to the journal.
  void wait_for_rows(const RunningProgram& running, std::uintmax_t before) const {
    while (size_of(journal_) <= before + 2000 && !running.has_ended())
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  // The result of one undisturbed run.
  std::string whole() const {
    EXPECT_EQ(run(kGrid, directory_.path() / "whole.csv").exit_code, 0);
    return text_of(directory_.path() / "whole.csv");
  }

  static constexpr const char* kScene = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";
  static constexpr const char* kGrid = "50x50";
  const validation::TemporaryDirectory directory_;
  const fs::path file_ = directory_.path() / "truth.csv";
  const fs::path journal_ = directory_.path() / "truth.csv.part";
};

TEST_F(TruthCommand, KilledAgainAndAgainItComesToTheSameBytes) {
  for (int kill = 0; kill < 5; ++kill) {
    const std::uintmax_t before = size_of(journal_);
    const RunningProgram running = start_slowly({"--resume"});
    wait_for_rows(running, before);
    running.send(SIGKILL);
    ASSERT_EQ(running.wait(), 128 + SIGKILL);
    ASSERT_GT(size_of(journal_), before);
    ASSERT_FALSE(fs::exists(file_));
  }
  const ProgramRun last = run(kGrid, file_, {"--resume"});
  EXPECT_EQ(last.exit_code, 0);
  EXPECT_NE(last.output.find(" of them in "), std::string::npos) << last.output;
  EXPECT_EQ(text_of(file_), whole());
  EXPECT_FALSE(fs::exists(journal_));
}

TEST_F(TruthCommand, ASignalKeepsWhatIsFinishedAndTellsHowToGoOn) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::uintmax_t before = size_of(journal_);
    const RunningProgram running = start_slowly({"--resume"});
    wait_for_rows(running, before);
    running.send(signal);
    EXPECT_EQ(running.wait(), 128 + signal);
    EXPECT_TRUE(running.error().starts_with("exactff: interrupted; ")) << running.error();
    EXPECT_NE(running.error().find(" rows are kept in " + journal_.string() +
                                   "; to continue, run the same command with --resume\n"),
              std::string::npos)
        << running.error();
  }
  EXPECT_EQ(run(kGrid, file_, {"--resume"}).exit_code, 0);
  EXPECT_EQ(text_of(file_), whole());
}

TEST_F(TruthCommand, TwoAtOnceAreRefused) {
  const RunningProgram first = start_slowly({});
  wait_for_rows(first, 0);
  for (const char* flag : {"--resume", "--force"}) {
    const RunningProgram second(EXACTFF_PROGRAM, truth(kGrid, file_, {flag}), directory_.path() / "stderr2");
    EXPECT_EQ(second.wait(), 2);
    EXPECT_EQ(second.error(),
              "exactff: " + journal_.string() +
                  ": another process is working on it (two processes would compute the same values and damage each "
                  "other's file); wait for the other process, or give another name with -o\n");
  }
  first.send(SIGKILL);
  EXPECT_EQ(first.wait(), 128 + SIGKILL);
  EXPECT_EQ(run(kGrid, file_, {"--resume"}).exit_code, 0);  // a dead process holds no lock
}

// The disk is full first for the journal, then for the file that is made from it.
TEST_F(TruthCommand, AFullDiskCostsNoRow) {
  const auto limited_to = [](rlim_t bytes) {
    return [bytes] {
      const rlimit both{bytes, bytes};
      ::setrlimit(RLIMIT_FSIZE, &both);
    };
  };
  const RunningProgram first = start(kGrid, {}, limited_to(50'000));
  EXPECT_EQ(first.wait(), 2);
  EXPECT_NE(first.error().find("truth.csv.part: cannot be written: File too large (it contains what is finished so "
                               "far); free some space, then continue with --resume"),
            std::string::npos)
      << first.error();
  EXPECT_GT(size_of(journal_), 30'000U);
  const std::string part = text_of(journal_);
  EXPECT_EQ(run(kGrid, directory_.path() / "b.csv").exit_code, 0);
  const std::string whole = text_of(directory_.path() / "b.csv");
  for (std::uintmax_t limit = whole.size() - 1; limit < whole.size() + 20'000; limit += 2000) {
    const RunningProgram next = start(kGrid, {"--resume"}, limited_to(limit));
    if (next.wait() == 0) break;
    EXPECT_NE(next.error().find("cannot be written: File too large"), std::string::npos);
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_FALSE(fs::exists(file_.string() + ".whole"));
  }
  EXPECT_EQ(run(kGrid, file_, {"--resume"}).exit_code, 0);
  EXPECT_EQ(text_of(file_), whole);
}

TEST_F(TruthCommand, ShardsAreMerged) {
  std::vector<std::string> merge{"merge"};
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    const fs::path part = directory_.path() / (std::string(shard, 1) + ".csv");
    EXPECT_EQ(run(kGrid, part, {"--shard", shard}).exit_code, 0);
    merge.push_back(part);
  }
  merge.insert(merge.end(), {"-o", file_});
  EXPECT_EQ(validation::run_program(EXACTFF_PROGRAM, merge).exit_code, 0);
  EXPECT_EQ(text_of(file_), whole());
  const RunningProgram again(EXACTFF_PROGRAM, merge, directory_.path() / "stderr");
  EXPECT_EQ(again.wait(), 2);
  EXPECT_NE(again.error().find("truth.csv: already exists"), std::string::npos);
  merge.erase(merge.begin() + 2);
  merge.push_back("--force");
  const RunningProgram less(EXACTFF_PROGRAM, merge, directory_.path() / "stderr");
  EXPECT_EQ(less.wait(), 2);
  EXPECT_EQ(less.error(), "exactff: of 3 shards these are missing: 2 (every row is needed); add these files\n");
}

TEST_F(TruthCommand, SenselessFlagsAreRefused) {
  for (const std::vector<std::string>& flags : std::vector<std::vector<std::string>>{{"--shard", "0/4"},
                                                                                     {"--shard", "5/4"},
                                                                                     {"--shard", "1"},
                                                                                     {"--shard", "1/"},
                                                                                     {"--shard", "/"},
                                                                                     {"--shard", "1/4x"},
                                                                                     {"--shard", "-1/4"},
                                                                                     {"--resume", "--force"},
                                                                                     {"--slow", "-1"},
                                                                                     {"--threads", "0"}}) {
    const RunningProgram running = start("1x1", flags);
    EXPECT_EQ(running.wait(), 2) << flags.back();
    EXPECT_FALSE(running.error().empty());
    EXPECT_FALSE(fs::exists(file_));
  }
}

// Several processes, started together by a launcher that the program does not support, would all do the same work.
TEST_F(TruthCommand, OneOfManyWithoutMpiIsRefused) {
  const fs::path alone = directory_.path() / "exactff";  // a copy of the program without its MPI module
  fs::copy_file(EXACTFF_PROGRAM, alone);
  const auto as_rank = [](const char* rank) {
    return [rank] {
      ::setenv("OMPI_COMM_WORLD_SIZE", "4", 1);
      ::setenv("OMPI_COMM_WORLD_RANK", rank, 1);
    };
  };
  const RunningProgram first(alone, truth("1x1", file_, {}), directory_.path() / "stderr", as_rank("0"));
  EXPECT_EQ(first.wait(), 2);
  EXPECT_NE(first.error().find("several processes were started together, but MPI is not available"), std::string::npos);
  const RunningProgram other(alone, truth("1x1", file_, {}), directory_.path() / "stderr", as_rank("3"));
  EXPECT_EQ(other.wait(), 0);
  EXPECT_EQ(other.error(), "");
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(TruthCommand, SlowRowsAreLogged) {
  const RunningProgram running = start("2x1", {"--slow", "0"});
  EXPECT_EQ(running.wait(), 0);
  EXPECT_TRUE(running.error().starts_with("slow: receiver 'r1c1' on 'floor', source 'light' took ")) << running.error();
}

}  // namespace
}  // namespace exactff
