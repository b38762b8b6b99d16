// A room, requests for truth files of it, and runs that are interrupted, for the tests of truth files.
#pragma once

#include <atomic>

#include "jobs/compute.h"
#include "jobs/journal.h"
#include "support/test.h"
#include "truth/rows.h"

namespace exactff::truth {

using jobs::Existing;
using jobs::RowHooks;

// A floor, two lights above it, and a board that hides the first from part of the floor.
inline Scene room() {
  std::istringstream obj(
      "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 3\nv 1 0 3\nv 1 1 3\nv 0 1 3\nv 3 3 3\nv 4 3 3\nv 4 4 3\nv 3 4 3\n"
      "v 0 0 1\nv 1 0 1\nv 1 2 1\nv 0 2 1\n"
      "g floor\nf 1 2 3 4\ng light\nf 8 7 6 5\ng lamp\nf 12 11 10 9\ng board\nf 13 14 15 16\n");
  return read_obj(obj, "room.obj");
}

// The line of a row.
inline void append(const Rows& rows, std::uint64_t row, std::string& text, Rows::Results& results) {
  rows.compute(row, results);
  rows.columns().append_csv(results.row, text);
}

class Truth : public testing::Test {
 protected:
  // 2 x n x n rows.
  Request request(int n) const {
    Request all;
    all.scene = &scene_;
    all.scene_name = "room.obj";
    all.receivers = grid_receivers(scene_, scene_.select("floor"), {n, n});
    all.receivers_name = "floor, grid";
    all.sources = {scene_.select("light"), scene_.select("lamp")};
    all.threads = 1;
    return all;
  }
  Request shard(int n, std::uint64_t number, std::uint64_t count) const {
    Request part = request(n);
    part.shard = {number, count};
    return part;
  }

  // A row asks `cancelled` about this often: before it, and in the loops of its value.
  static constexpr int kQuestions = 4;

  // Ends the run after about `rows` rows.
  void interrupt(Request asked, int rows) const {
    std::atomic<int> left = rows * kQuestions;
    RowHooks hooks;
    hooks.cancelled = [&left] { return left-- <= 0; };
    EXPECT_THROW(write(std::move(asked), file_, Existing::kResume, hooks), Cancelled);
  }

  std::string refusal(Request asked, Existing existing) const {
    return complaint([&] { write(std::move(asked), file_, existing); });
  }

  std::uint64_t rows_in_journal(Request asked) const {
    const Rows rows(std::move(asked));
    const jobs::RowJournal journal(file_, rows, Existing::kResume, {});
    return rows.shard_rows() - jobs::Schedule(rows, journal.blocks()).rows();
  }
  void expect_only(const std::set<std::string>& names) const { EXPECT_EQ(names_in(directory_.path()), names); }

  const Scene scene_ = room();
  const TemporaryDirectory directory_{memory_folder()};
  const std::filesystem::path file_ = directory_.path() / "truth.csv";
  const std::filesystem::path journal_ = jobs::journal_of(file_);
};

}  // namespace exactff::truth
