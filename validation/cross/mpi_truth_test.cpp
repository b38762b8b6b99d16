// exactff truth and matrix under mpirun: four processes, independent of the number of cores.
#include <chrono>
#include <csignal>
#include <iterator>
#include <thread>

#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::RunningProgram;
using validation::size_of;
using validation::text_of;

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

class MpiTruth : public testing::Test {
 protected:
  static std::vector<std::string> truth(const std::string& on, const fs::path& file, std::vector<std::string> more) {
    std::vector<std::string> all{
        "truth", EXACTFF_DATA_DIR "/scenes/cornell_box.obj", "--on", on, "--grid", "160x160", "-o", file};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  RunningProgram start(const std::vector<std::string>& arguments,
                       const std::vector<std::string>& launch_options = {}) const {
    std::vector<std::string> all{"--oversubscribe", "-n", "4"};
    all.insert(all.end(), launch_options.begin(), launch_options.end());
    all.push_back(EXACTFF_PROGRAM);
    all.insert(all.end(), arguments.begin(), arguments.end());
    return {EXACTFF_MPIRUN, all, directory_.path() / "stderr", [] {
              ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
              ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
            }};
  }
  std::string whole() const {
    const fs::path file = directory_.path() / "whole.csv";
    EXPECT_EQ(validation::run_program(EXACTFF_PROGRAM, truth("floor", file, {})).exit_code, 0);
    return text_of(file);
  }
  static std::vector<int> children_of(int process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/task/" + std::to_string(process) + "/children");
    return {std::istream_iterator<int>(file), {}};
  }

  const validation::TemporaryDirectory directory_;
  const fs::path file_ = directory_.path() / "truth.csv";
  const fs::path journal_ = directory_.path() / "truth.csv.part";
};

TEST_F(MpiTruth, FourProcessesWriteTheBytesOfOne) {
  const RunningProgram run = start(truth("floor", file_, {}));
  EXPECT_EQ(run.wait(), 0) << run.error();
  EXPECT_EQ(text_of(file_), whole());
}

TEST_F(MpiTruth, AKilledProcessCostsNoFinishedRow) {
  int killed = 0;
  // mpirun needs some time to end the other processes, which continue meanwhile and may even finish.
  for (std::size_t victim = 0; victim < 4 && !fs::exists(file_); ++victim) {
    const std::uintmax_t before = size_of(journal_);
    const RunningProgram run = start(truth("floor", file_, {"--resume", "--engine", "boolean"}));
    while (size_of(journal_) <= before + 2000 && !run.has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const std::vector<int> ranks = children_of(run.process());
    if (run.has_ended()) break;
    ASSERT_EQ(ranks.size(), 4U) << run.error();
    ::kill(ranks[victim], SIGKILL);
    EXPECT_NE(run.wait(), 0);
    ASSERT_TRUE(fs::exists(file_) || size_of(journal_) > before);
    ++killed;
  }
  EXPECT_GT(killed, 0);
  const validation::ProgramRun alone = validation::run_program(EXACTFF_PROGRAM, truth("floor", file_, {"--resume"}));
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_TRUE(alone.output.find(" of them in ") != std::string::npos ||
              alone.output.find("all rows were already computed") != std::string::npos)
      << alone.output;
  EXPECT_EQ(text_of(file_), whole());
}

// Pairs of patches, from microseconds to a second each.
TEST_F(MpiTruth, AMatrixOfKilledProcessesHasTheBytesOfOne) {
  const auto matrix = [](const fs::path& file, const std::vector<std::string>& more) {
    std::vector<std::string> all{
        "matrix", EXACTFF_DATA_DIR "/scenes/cornell_box.obj", "--accuracy", "1e-3", "--budget", "300", "--backs", "-o",
        file};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const fs::path alone = directory_.path() / "alone.csv";
  constexpr int kWide = 3;  // the budget is too small for the accuracy
  EXPECT_EQ(validation::run_program(EXACTFF_PROGRAM, matrix(alone, {})).exit_code, kWide);
  for (std::size_t victim = 0; victim < 2 && !fs::exists(file_); ++victim) {
    const std::uintmax_t before = size_of(journal_);
    const RunningProgram run = start(matrix(file_, {"--resume"}));
    while (size_of(journal_) <= before + 100 && !run.has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const std::vector<int> ranks = children_of(run.process());
    if (run.has_ended() || ranks.size() != 4) break;
    ::kill(ranks[3 * victim], SIGKILL);
    EXPECT_NE(run.wait(), 0);
    EXPECT_TRUE(fs::exists(file_) || size_of(journal_) > before);
  }
  const RunningProgram last = start(matrix(file_, {"--resume"}));
  EXPECT_EQ(last.wait(), kWide) << last.error();
  EXPECT_EQ(text_of(file_), text_of(alone));
  const RunningProgram without_file = start({"matrix", EXACTFF_DATA_DIR "/scenes/cornell_box.obj"});
  EXPECT_EQ(without_file.wait(), 2);
  EXPECT_EQ(count(without_file.error(), "exactff: "), 1U) << without_file.error();
}

TEST_F(MpiTruth, WhatIsWrongIsToldOnce) {
  for (const std::vector<std::string>& arguments :
       {truth("flor", file_, {}), truth("floor", file_, {"--shard", "9/4"}), truth("floor", file_, {"--what"}),
        truth("floor", file_, {"--npy", file_}), truth("floor", file_, {"--npy"})}) {
    const RunningProgram run = start(arguments);
    EXPECT_EQ(run.wait(), 2);
    const std::string error = run.error();
    EXPECT_EQ(count(error, "exactff: ") + count(error, "--help"), 1U) << error;
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_FALSE(fs::exists(journal_));
  }
}

// mpirun ends what still runs when another process has ended with an exit code other than 0, once the error is told.
// That is no interruption to report.
TEST_F(MpiTruth, ASlowEndIsNoInterruption) {
  const auto expect_one_error = [&](const std::vector<std::string>& arguments, const std::string& slow_rank) {
    const RunningProgram run =
        start(arguments, {"-x", "LD_PRELOAD=" EXACTFF_SLOW_FINALIZE, "-x", "SLOW_RANK=" + slow_rank});
    EXPECT_EQ(run.wait(), 2);
    EXPECT_EQ(count(run.error(), "exactff: "), 1U) << run.error();
  };
  expect_one_error(truth("flor", file_, {}), "0");
  expect_one_error({"matrix", EXACTFF_DATA_DIR "/scenes/cornell_box.obj"}, "1");  // refused before there is any work
}

}  // namespace
}  // namespace exactff
