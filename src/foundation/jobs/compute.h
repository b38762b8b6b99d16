// From rows to a journal that holds all of them, and from there to a table.
//
// 1. Check that no other work would be destroyed: the file and its journal.
// 2. Read from the journal which rows are done. Distribute the others by chunks to any idle worker: threads of this
//    process, and other processes if there is a team.
// 3. Append finished rows to the journal at once, in any order. Make it durable every second.
// 4. When every row is in the journal, write the file in order under a temporary name and rename it. Then remove the
//    journal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/jobs.h"
#include "files/parallel.h"
#include "jobs/journal.h"
#include "jobs/rows.h"
#include "jobs/team.h"

namespace exactff::jobs {

// Hands out the rows that remain to be computed, in order, in pieces of at most a chunk.
class Schedule {
 public:
  // `done` must be sorted by row, and no block may cross the bounds of a chunk.
  Schedule(const Rows& rows, std::span<const Block> done);

  // From any thread. Nothing if all rows have been handed out.
  [[nodiscard]] std::optional<Range> next();
  // How many rows remained at the start.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }

 private:
  [[nodiscard]] std::optional<Range> advance();

  std::mutex mutex_;
  const Plan plan_;
  std::vector<Range> done_;
  std::size_t next_done_ = 0;
  std::uint64_t position_;
  std::uint64_t rows_ = 0;
};

// What a thread does: computes the rows that it takes, until there are none or the pool stops. Finished rows are
// delivered at least every second, and whatever is thrown.
void compute_rows(const Rows& rows, double slow_seconds, const TakeRange& take, const DeliverRows& deliver,
                  files::WorkerPool::Worker& worker);

// Computes the table, or the shard of it, by way of a journal, and writes it as CSV: on threads of this process, and on
// the other processes if there is a team, whose leader this must be. With a complete file and `existing` to continue,
// only reads it. `see` gets all rows. Throws InputError if the file or the journal is unusable, or if nothing can be
// written; throws Cancelled if the hooks cancel. Whatever is thrown, finished rows are in the journal.
Summary write(const Rows& rows, const std::filesystem::path& file, Existing existing, const RowHooks& hooks, Team* team,
              const See& see = {});

}  // namespace exactff::jobs
