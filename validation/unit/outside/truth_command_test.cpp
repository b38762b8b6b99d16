// exactff truth and exactff merge as scripts run them: killed, interrupted, on full disks, twice at once.
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

class TruthCommand : public testing::Test {
 protected:
  Words truth(const std::string& grid, const fs::path& file, Words more) const {
    return joined({"truth", kScene, "--on", "floor", "--grid", grid, "-o", file}, more);
  }
  ProgramRun run(const std::string& grid, const fs::path& file, const Words& more = {}) const {
    return run_exactff(truth(grid, file, more));
  }
  RunningProgram start(
      const std::string& grid, const Words& more, const std::function<void()>& prepare = [] {}) const {
    return {EXACTFF_PROGRAM, truth(grid, file_, more), directory_.path() / "stderr", prepare};
  }
  // The Boolean engine is slow, which gives the test time, and it gives the same bytes.
  RunningProgram start_slowly(Words more) const {
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
  const TemporaryDirectory directory_;
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
  EXPECT_HOLDS(last.output, " of them in ");
  EXPECT_EQ(text_of(file_), whole());
  EXPECT_FALSE(fs::exists(journal_));
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
  EXPECT_HOLDS(first.error(),
               "truth.csv.part: cannot be written: File too large (it contains what is finished so "
               "far); free some space, then continue with --resume");
  EXPECT_GT(size_of(journal_), 30'000U);
  const std::string part = text_of(journal_);
  EXPECT_EQ(run(kGrid, directory_.path() / "b.csv").exit_code, 0);
  const std::string whole = text_of(directory_.path() / "b.csv");
  for (std::uintmax_t limit = whole.size() - 1; limit < whole.size() + 20'000; limit += 2000) {
    const RunningProgram next = start(kGrid, {"--resume"}, limited_to(limit));
    if (next.wait() == 0) break;
    EXPECT_HOLDS(next.error(), "cannot be written: File too large");
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_FALSE(fs::exists(file_.string() + ".whole"));
  }
  EXPECT_EQ(run(kGrid, file_, {"--resume"}).exit_code, 0);
  EXPECT_EQ(text_of(file_), whole);
}

TEST_F(TruthCommand, SenselessFlagsAreRefused) {
  std::vector<Words> senseless{{"--resume", "--force"}, {"--slow", "-1"}, {"--threads", "0"}};
  for (const char* shard : {"0/4", "5/4", "1", "1/", "/", "1/4x", "-1/4"}) senseless.push_back({"--shard", shard});
  for (const Words& flags : senseless) {
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
  EXPECT_HOLDS(first.error(), "several processes were started together, but MPI is not available");
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
