// Matrices with a journal: interrupted, in shards; and read again.
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "support/test.h"

namespace exactff::matrix {
namespace {

namespace fs = std::filesystem;
using jobs::Existing;

// Four walls and a floor that look inward, and a table without a bottom. One name needs quotes.
Scene room() {
  PlainScene scene;
  for (const auto& [side, corners] : sides_of({0, 0, 0}, {1, 1, 1})) {
    if (side != "ceiling") add(scene, side == "left" ? "left, \"west\"" : side, corners);
  }
  add(scene, "table", {{0.25, 0.25, 0.5}, {0.5, 0.25, 0.5}, {0.5, 0.5, 0.5}, {0.25, 0.5, 0.5}});
  return generate::build(scene);
}

class MatrixJobs : public testing::Test {
 protected:
  Request request(double accuracy = 0.01) const {
    Request all;
    all.scene = &scene_;
    all.from = all.to = all_patches(scene_);
    all.options = {.factors = {.accuracy = accuracy, .budget = 300}, .backs = true, .open = true, .threads = 1};
    return all;
  }
  Request shard(std::uint64_t number, std::uint64_t count) const {
    Request part = request();
    part.shard = {number, count};
    return part;
  }
  std::string text_of_table(const Matrix& matrix) const {
    return table::csv_text(table_of(scene_, matrix, request().options.factors));
  }
  std::string expected() const {
    const Request all = request();
    return text_of_table(compute(scene_, all.from, all.to, all.options));
  }

  // Ends the run when `cancelled` has been asked this often.
  void interrupt(const Request& asked, int questions) const {
    std::atomic<int> left = questions;
    jobs::RowHooks hooks;
    hooks.cancelled = [&left] { return left-- <= 0; };
    EXPECT_THROW(write(asked, file_, Existing::kResume, hooks), Cancelled);
  }
  // Leaves a journal with some pairs, but not all.
  std::string journal_of_an_interrupted_run() const {
    for (int questions = 100; !fs::exists(journal_); questions += 100) interrupt(request(), questions);
    return text_of(journal_);
  }
  std::vector<fs::path> shards(std::uint64_t count) const {
    std::vector<fs::path> files;
    for (std::uint64_t number = 1; number <= count; ++number) {
      files.push_back(directory_.path() / ("part" + std::to_string(number) + ".csv"));
      write(shard(number, count), files.back(), Existing::kReplace);
    }
    return files;
  }

  const Scene scene_ = room();
  const TemporaryDirectory directory_{memory_folder()};
  const fs::path file_ = directory_.path() / "factors.csv";
  const fs::path journal_ = jobs::journal_of(file_);
  static constexpr std::uint64_t kPairs = 21 + 6 + 6;
};

TEST_F(MatrixJobs, BytesAreThoseOfAMatrixWithoutAJournal) {
  for (const int threads : {1, 3}) {
    Request asked = request();
    asked.options.threads = threads;
    const jobs::Summary summary = write(asked, file_, Existing::kReplace);
    EXPECT_EQ(summary.rows, kPairs);
    EXPECT_EQ(summary.resumed, 0U);
    EXPECT_EQ(text_of(file_), expected());
    EXPECT_FALSE(fs::exists(journal_));
  }
}

TEST_F(MatrixJobs, AreReadToTheSameBits) {
  const Request asked = request();
  write(asked, file_);
  EXPECT_EQ(table::kind_of(file_), "matrix");
  EXPECT_EQ(text_of_table(read(asked, file_)), expected());
  Request fewer = asked;
  fewer.to.pop_back();
  EXPECT_HOLDS(complaint([&] { (void)read(fewer, file_); }), "holds other rows or columns");
  fewer = asked;
  fewer.options.open = false;
  EXPECT_HOLDS(complaint([&] { (void)read(fewer, file_); }), "holds other rows or columns");
}

TEST_F(MatrixJobs, AJournalOfAnotherRequestIsRefused) {
  const std::string journal = journal_of_an_interrupted_run();
  std::vector<std::pair<Request, std::string>> others;
  others.emplace_back(request(0.02), "accuracy 0.01");
  others.emplace_back(request(), "budget 300");
  others.back().first.options.factors.budget = 99;
  others.emplace_back(request(), "patches hash");
  std::swap(others.back().first.to[0], others.back().first.to[1]);
  others.emplace_back(request(), "further (back) and (open)");
  others.back().first.options.backs = false;
  for (const auto& [asked, words] : others) {
    const std::string message = complaint([&, &other = asked] { write(other, file_, Existing::kResume); });
    EXPECT_HOLDS(message, "belongs to a different request") << words << message;
    EXPECT_HOLDS(message, words);
    EXPECT_EQ(text_of(journal_), journal);
  }
}

TEST_F(MatrixJobs, ACompleteFileIsLeftAsItIs) {
  write(request(), file_);
  const auto before = fs::last_write_time(file_);
  EXPECT_EQ(write(request(), file_, Existing::kResume).resumed, kPairs);
  EXPECT_EQ(fs::last_write_time(file_), before);
  EXPECT_HOLDS(complaint([&] { write(request(), file_); }), "already exists");
  EXPECT_HOLDS(complaint([&] { write(request(0.02), file_, Existing::kResume); }), "different request");
  const std::string whole = text_of(file_);
  write_text(file_, whole.substr(0, whole.rfind('\n', whole.size() - 2) + 1));  // without the last entry
  EXPECT_NE(complaint([&] { write(request(), file_, Existing::kResume); }), "");
}

TEST_F(MatrixJobs, WhatDoesNotBelongTogetherIsNotMerged) {
  const std::vector<fs::path> files = shards(3);
  const auto refusal = [&](std::vector<fs::path> given) { return complaint([&] { jobs::merge(given, file_); }); };
  EXPECT_HOLDS(refusal({files[0], files[2]}), "these are missing: 2");
  EXPECT_HOLDS(refusal({files[0], files[1], files[0], files[2]}), "is shard 1, and so is");
  const fs::path other = directory_.path() / "other.csv";
  Request asked = request(0.02);
  asked.shard = {2, 3};
  write(asked, other);
  EXPECT_HOLDS(refusal({files[0], other, files[2]}), "belongs to a different request");
  std::string damaged = text_of(files[1]);
  damaged[damaged.size() - 20] ^= 1;
  write_text(files[1], damaged);
  EXPECT_HOLDS(refusal(files), "is damaged");
  write(request(), directory_.path() / "whole.csv");
  EXPECT_HOLDS(refusal({directory_.path() / "whole.csv"}), "is not a shard of a table");
  EXPECT_FALSE(fs::exists(file_));
}

class MatrixCommand : public testing::Test {
 protected:
  static Words matrix(const fs::path& file, const Words& more) {
    return joined({"matrix", EXACTFF_DATA_DIR "/scenes/cornell_box.obj", "--accuracy", "1e-3", "--budget", "200",
                   "--backs", "--to", "all,sky", "-o", file},
                  more);
  }
  static ProgramRun run(const fs::path& file, const Words& more = {}) { return run_exactff(matrix(file, more)); }
  std::string whole() const {
    EXPECT_EQ(run(directory_.path() / "whole.csv").exit_code, kWide);
    return text_of(directory_.path() / "whole.csv");
  }

  static constexpr int kWide = 3;  // the budget is too small for the accuracy
  const TemporaryDirectory directory_;
  const fs::path file_ = directory_.path() / "factors.csv";
  const fs::path journal_ = directory_.path() / "factors.csv.part";
};

TEST_F(MatrixCommand, KilledAndInterruptedItComesToTheSameBytes) {
  int ended_early = 0;
  for (const int signal : {SIGKILL, SIGINT, SIGTERM}) {
    const std::uintmax_t before = size_of(journal_);
    const RunningProgram running(EXACTFF_PROGRAM, matrix(file_, {"--resume", "--threads", "1"}),
                                 directory_.path() / "stderr");
    while (size_of(journal_) <= before + 100 && !running.has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    running.send(signal);
    const auto sent = std::chrono::steady_clock::now();
    if (running.wait() != 128 + signal) break;                                    // it was faster
    EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(5));  // machines may be busy
    ++ended_early;
    EXPECT_FALSE(fs::exists(file_));
    if (signal == SIGKILL) continue;
    EXPECT_HOLDS(running.error(), " pairs are kept in " + journal_.string());
  }
  EXPECT_GT(ended_early, 0);
  EXPECT_EQ(run(file_, {"--resume"}).exit_code, kWide);
  EXPECT_EQ(text_of(file_), whole());
  EXPECT_FALSE(fs::exists(journal_));
}

TEST_F(MatrixCommand, ShardsAreMergedAndGiveTheOtherFiles) {
  const std::string one = directory_.path() / "1.csv", two = directory_.path() / "2.csv";
  EXPECT_EQ(run(one, {"--shard", "1/2"}).exit_code, 0);
  EXPECT_EQ(run(two, {"--shard", "2/2"}).exit_code, 0);
  const ProgramRun merged = run_exactff({"merge", two, one, "-o", file_.string()});
  EXPECT_EQ(merged.exit_code, kWide);
  EXPECT_HOLDS(merged.output, "Matrix: ");
  EXPECT_EQ(text_of(file_), whole());
  const fs::path npz = directory_.path() / "factors.npz", alone = directory_.path() / "alone.npz";
  EXPECT_EQ(run(file_, {"--resume", "--npz", npz}).exit_code, kWide);
  EXPECT_EQ(run(directory_.path() / "alone.csv", {"--npz", alone}).exit_code, kWide);
  EXPECT_EQ(text_of(npz), text_of(alone));
}

}  // namespace
}  // namespace exactff::matrix
