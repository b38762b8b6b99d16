// The shards of a truth file: which rows belong to each, and merging them.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "jobs/blocks.h"
#include "jobs/compute.h"
#include "support/complaint.h"
#include "support/folder.h"
#include "support/program.h"
#include "truth/rows.h"
#include "unit/products/truth_support.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;
using namespace jobs;
using validation::complaint;
using validation::text_of;
using validation::write_text;

// --- schedule --------------------------------------------------------------------------------------------------------

TEST_F(Truth, TheScheduleDealsOutWhatIsNotDone) {
  const Rows rows(request(10));  // 200 rows, the last chunk of 8
  std::vector<Block> done;
  for (const Range range : {Range{0, 3}, Range{10, 54}, Range{130, 62}, Range{192, 8}}) {
    done.push_back({name_of(range)});
  }
  Schedule schedule(rows, done);
  EXPECT_EQ(schedule.rows(), 73U);
  EXPECT_EQ(schedule.next(), (Range{3, 7}));
  EXPECT_EQ(schedule.next(), (Range{64, 64}));
  EXPECT_EQ(schedule.next(), (Range{128, 2}));
  EXPECT_EQ(schedule.next(), std::nullopt);
}

TEST_F(Truth, ShardsShareTheRowsAmongThem) {
  for (const std::uint64_t count : {1U, 2U, 3U, 4U, 5U, 9U}) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t number = 1; number <= count; ++number) {
      const Rows rows(shard(10, number, count));
      Schedule schedule(rows, {});
      std::uint64_t dealt = 0;
      while (const std::optional<Range> range = schedule.next()) {
        EXPECT_TRUE(rows.may_be_one_block(*range));
        for (std::uint64_t row = range->first; row < range->end(); ++row) EXPECT_TRUE(seen.insert(row).second);
        dealt += range->rows;
      }
      EXPECT_EQ(dealt, rows.shard_rows());
    }
    EXPECT_EQ(seen.size(), 200U);
  }
}

// --- merging ---------------------------------------------------------------------------------------------------------

class TruthShards : public Truth {
 protected:
  fs::path part(std::uint64_t number) const { return directory_.path() / ("truth." + std::to_string(number) + ".csv"); }
  std::vector<fs::path> write_shards(int n, std::uint64_t count) const {
    std::vector<fs::path> parts;
    for (std::uint64_t number = 1; number <= count; ++number) {
      parts.push_back(part(number));
      write(shard(n, number, count), parts.back(), Existing::kReplace);
    }
    return parts;
  }
  std::string merge_refusal(const std::vector<fs::path>& parts) const {
    return complaint([&] { truth::merge(parts, directory_.path() / "merged.csv"); });
  }
};

TEST_F(TruthShards, MergedAreTheBytesOfOneRun) {
  const Summary one = write(request(10), file_);
  for (const std::uint64_t count : {2U, 3U, 4U, 7U}) {  // of 4 chunks, so that some shards have none
    std::vector<fs::path> parts = write_shards(10, count);
    std::reverse(parts.begin(), parts.end());
    const fs::path merged = directory_.path() / "merged.csv";
    const Summary summary = truth::merge(parts, merged, Existing::kReplace);
    EXPECT_EQ(text_of(merged), text_of(file_));
    EXPECT_EQ(summary.rows_by_status, one.rows_by_status);
  }
}

TEST_F(TruthShards, InterruptionsDoNotShow) {
  const std::vector<fs::path> parts = write_shards(10, 2);
  for (const int rows : {30, 3, 50}) {
    std::atomic<int> left = rows;
    RowHooks hooks;
    hooks.cancelled = [&left] { return left-- <= 0; };
    EXPECT_THROW(write(shard(10, 1, 2), file_, Existing::kResume, hooks), Cancelled);
  }
  EXPECT_NE(merge_refusal({journal_, parts[1]}).find("is the journal of an unfinished run"), std::string::npos);
  write(shard(10, 1, 2), file_, Existing::kResume);
  EXPECT_EQ(text_of(file_), text_of(parts[0]));
  const Summary again = write(shard(10, 1, 2), file_, Existing::kResume);
  EXPECT_EQ(again.resumed, again.rows);
}

TEST_F(TruthShards, WhatDoesNotBelongTogetherIsRefused) {
  const std::vector<fs::path> parts = write_shards(10, 3);
  const auto expect = [&](const std::vector<fs::path>& named, const std::string& message) {
    const std::string told = merge_refusal(named);
    EXPECT_NE(told.find(message), std::string::npos) << told;
    EXPECT_FALSE(fs::exists(directory_.path() / "merged.csv"));
  };
  expect({parts[0], parts[2]}, "of 3 shards these are missing: 2 (every row is needed)");
  expect({parts[0]}, "these are missing: 2 and 3");
  expect({}, "no shard is named");
  expect({parts[0], parts[1], parts[2], parts[1]}, "is shard 2, and so is ");
  expect({parts[0], directory_.path() / "nothing"}, "nothing: cannot be read: No such file");
  write(request(10), file_);
  expect({parts[0], parts[1], file_}, "truth.csv: is not a shard of a table");
  write(shard(10, 3, 4), file_, Existing::kReplace);
  expect({parts[0], parts[1], file_}, "is one of 4 shards");
  write(shard(9, 3, 3), file_, Existing::kReplace);
  expect({parts[0], parts[1], file_}, "truth.csv:1: belongs to a different request: it has receivers hash ");
}

TEST_F(TruthShards, DamageIsFoundWhereverItIs) {
  const std::vector<fs::path> parts = write_shards(10, 2);
  const std::string sound = text_of(parts[0]);
  const std::size_t rows = sound.find("\n# rows 0+64") + 1;
  for (std::size_t at = rows; at < sound.size(); at += 97) {
    std::string damaged = sound;
    damaged[at] ^= 1;
    write_text(parts[0], damaged);
    EXPECT_NE(merge_refusal(parts).find("truth.1.csv: is damaged: "), std::string::npos) << at;
    write_text(parts[0], sound.substr(0, at));
    EXPECT_NE(merge_refusal(parts).find("truth.1.csv: is damaged: "), std::string::npos) << at;
  }
  write_text(parts[0], sound + "more");
  EXPECT_NE(merge_refusal(parts).find("is damaged: "), std::string::npos);
}

}  // namespace
}  // namespace exactff::truth
