// Matrices with a journal: interrupted, in shards, by several processes; and read again.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "exactff/matrix.h"
#include "generate/plain_scene.h"
#include "jobs/team.h"
#include "matrix/team.h"
#include "support/complaint.h"
#include "support/folder.h"
#include "support/program.h"
#include "support/thread_team.h"

namespace exactff::matrix {
namespace {

namespace fs = std::filesystem;
using jobs::Existing;
using validation::complaint;
using validation::Mailbox;
using validation::RunningProgram;
using validation::size_of;
using validation::text_of;
using validation::ThreadTeam;
using validation::write_text;

// Four walls and a floor that look inward, and a table without a bottom. One name needs quotes.
Scene room() {
  generate::PlainScene scene;
  const auto add = [&](const char* name, const std::vector<Vec3>& corners) {
    scene.add_ring(scene.patch(name), corners);
  };
  add("floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add("left, \"west\"", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  add("right", {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});
  add("near", {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  add("far", {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}});
  add("table", {{0.25, 0.25, 0.5}, {0.5, 0.25, 0.5}, {0.5, 0.5, 0.5}, {0.25, 0.5, 0.5}});
  return generate::build(scene);
}

class MatrixJobs : public testing::Test {
 protected:
  Request request(double accuracy = 0.01) const {
    Request all;
    all.scene = &scene_;
    for (std::size_t i = 0; i < scene_.patches().size(); ++i) {
      all.from.push_back({static_cast<PatchId>(i), {}, scene_.id()});
    }
    all.to = all.from;
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
  const validation::TemporaryDirectory directory_{validation::memory_folder()};
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
  EXPECT_NE(complaint([&] { (void)read(fewer, file_); }).find("holds other rows or columns"), std::string::npos);
  fewer = asked;
  fewer.options.open = false;
  EXPECT_NE(complaint([&] { (void)read(fewer, file_); }).find("holds other rows or columns"), std::string::npos);
}

TEST_F(MatrixJobs, AnInterruptedRunGoesOn) {
  (void)journal_of_an_interrupted_run();
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_NE(complaint([&] { write(request(), file_); }).find("contains the finished work of an interrupted run"),
            std::string::npos);
  const jobs::Summary summary = write(request(), file_, Existing::kResume);
  EXPECT_GT(summary.resumed, 0U);
  EXPECT_LT(summary.resumed, kPairs);
  EXPECT_EQ(text_of(file_), expected());
}

TEST_F(MatrixJobs, AJournalTornAnywhereGoesOn) {
  const std::string journal = journal_of_an_interrupted_run(), whole = expected();
  for (std::size_t size = 0; size < journal.size(); size += 1 + journal.size() / 13) {
    fs::remove(file_);
    write_text(journal_, journal.substr(0, size));
    write(request(), file_, Existing::kResume);
    ASSERT_EQ(text_of(file_), whole) << size;
  }
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
    EXPECT_NE(message.find("belongs to a different request"), std::string::npos) << words << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(text_of(journal_), journal);
  }
}

TEST_F(MatrixJobs, ACompleteFileIsLeftAsItIs) {
  write(request(), file_);
  const auto before = fs::last_write_time(file_);
  EXPECT_EQ(write(request(), file_, Existing::kResume).resumed, kPairs);
  EXPECT_EQ(fs::last_write_time(file_), before);
  EXPECT_NE(complaint([&] { write(request(), file_); }).find("already exists"), std::string::npos);
  EXPECT_NE(complaint([&] { write(request(0.02), file_, Existing::kResume); }).find("different request"),
            std::string::npos);
  const std::string whole = text_of(file_);
  write_text(file_, whole.substr(0, whole.rfind('\n', whole.size() - 2) + 1));  // without the last entry
  EXPECT_NE(complaint([&] { write(request(), file_, Existing::kResume); }), "");
}

// --- shards ----------------------------------------------------------------------------------------------------------

TEST_F(MatrixJobs, ShardsAreMergedToTheBytesOfOneRun) {
  for (const std::uint64_t count : {2U, 5U}) {
    std::vector<fs::path> files = shards(count);
    std::ranges::reverse(files);
    EXPECT_EQ(jobs::merge(files, file_, Existing::kReplace).rows, kPairs);
    EXPECT_EQ(text_of(file_), expected());
  }
}

TEST_F(MatrixJobs, WhatDoesNotBelongTogetherIsNotMerged) {
  const std::vector<fs::path> files = shards(3);
  const auto refusal = [&](std::vector<fs::path> given) { return complaint([&] { jobs::merge(given, file_); }); };
  EXPECT_NE(refusal({files[0], files[2]}).find("these are missing: 2"), std::string::npos);
  EXPECT_NE(refusal({files[0], files[1], files[0], files[2]}).find("is shard 1, and so is"), std::string::npos);
  const fs::path other = directory_.path() / "other.csv";
  Request asked = request(0.02);
  asked.shard = {2, 3};
  write(asked, other);
  EXPECT_NE(refusal({files[0], other, files[2]}).find("belongs to a different request"), std::string::npos);
  std::string damaged = text_of(files[1]);
  damaged[damaged.size() - 20] ^= 1;
  write_text(files[1], damaged);
  EXPECT_NE(refusal(files).find("is damaged"), std::string::npos);
  write(request(), directory_.path() / "whole.csv");
  EXPECT_NE(refusal({directory_.path() / "whole.csv"}).find("is not a shard of a table"), std::string::npos);
  EXPECT_FALSE(fs::exists(file_));
}

// --- several processes, here threads ---------------------------------------------------------------------------------

TEST_F(MatrixJobs, ManyProcessesWriteTheBytesOfOne) {
  std::vector<Mailbox> mail(4);
  {
    std::vector<std::jthread> followers;
    for (int rank = 1; rank < 4; ++rank) {
      followers.emplace_back([&, rank] {
        ThreadTeam team(mail, rank);
        (void)follow(team, [&] { return request(); }, {});
      });
    }
    ThreadTeam team(mail, 0);
    write(request(), file_, Existing::kRefuse, {}, &team);
    jobs::dismiss(team, 0);
  }
  EXPECT_EQ(text_of(file_), expected());
}

// --- the command -----------------------------------------------------------------------------------------------------

class MatrixCommand : public testing::Test {
 protected:
  static std::vector<std::string> matrix(const fs::path& file, const std::vector<std::string>& more) {
    std::vector<std::string> all{"matrix",     EXACTFF_DATA_DIR "/scenes/cornell_box.obj",
                                 "--accuracy", "1e-3",
                                 "--budget",   "200",
                                 "--backs",    "--to",
                                 "all,sky",    "-o",
                                 file};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  static validation::ProgramRun run(const fs::path& file, const std::vector<std::string>& more = {}) {
    return validation::run_program(EXACTFF_PROGRAM, matrix(file, more));
  }
  std::string whole() const {
    EXPECT_EQ(run(directory_.path() / "whole.csv").exit_code, kWide);
    return text_of(directory_.path() / "whole.csv");
  }

  static constexpr int kWide = 3;  // the budget is too small for the accuracy
  const validation::TemporaryDirectory directory_;
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
    EXPECT_NE(running.error().find(" pairs are kept in " + journal_.string()), std::string::npos) << running.error();
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
  const validation::ProgramRun merged =
      validation::run_program(EXACTFF_PROGRAM, {"merge", two, one, "-o", file_.string()});
  EXPECT_EQ(merged.exit_code, kWide);
  EXPECT_NE(merged.output.find("Matrix: "), std::string::npos) << merged.output;
  EXPECT_EQ(text_of(file_), whole());
  const fs::path npz = directory_.path() / "factors.npz", alone = directory_.path() / "alone.npz";
  EXPECT_EQ(run(file_, {"--resume", "--npz", npz}).exit_code, kWide);
  EXPECT_EQ(run(directory_.path() / "alone.csv", {"--npz", alone}).exit_code, kWide);
  EXPECT_EQ(text_of(npz), text_of(alone));
}

}  // namespace
}  // namespace exactff::matrix
