// From rows to a journal that holds all of them, and from there to files. Rows are computed by threads and, if there is
// a team (team.h), by other processes.
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

// Computes the rows that are not in the journal and appends them to it: on threads of this process, and on the other
// processes if there is a team, whose leader this must be. Sets resumed, slow and seconds. Whatever is thrown, finished
// rows are in the journal.
void compute_missing(const Rows& rows, RowJournal& journal, Team* team, const RowHooks& hooks, Summary& summary);

// A file in which nothing of the journal is lost, whatever happens to it.
[[nodiscard]] files::FailureAdvice advice_while_in_journal(const RowJournal& journal);

// Calls take(range, text) for every chunk, in order. Requires every row of the shard to be in the journal. `take`
// returns false if the text cannot be that of these rows, which then is an internal failure.
using TakeChunk = std::function<bool(Range range, const std::string& text)>;
void for_each_chunk(const Rows& rows, const RowJournal& journal, const RowHooks& hooks, const TakeChunk& take);

// Writes the rows in order, after their head: one after another, or the chunks of a shard as blocks. Calls `see` with
// each chunk.
void write_rows(const Rows& rows, const RowJournal& journal, const std::filesystem::path& file, const RowHooks& hooks,
                const TakeChunk& see);

// Whether `existing` continues a run, and this file of it is complete: files appear only when they are complete.
[[nodiscard]] bool is_complete(const std::filesystem::path& file, Existing existing);

// Throws InputError unless the file, or the shard, has the head of these rows. Returns the number of bytes of the head.
std::uint64_t require_head(const File& file, const Rows& rows);
// As above, and unless every row of the shard is there. Calls take(text) for each chunk.
void require_shard_file(const File& file, const Rows& rows, const std::function<void(const std::string& text)>& take);
[[noreturn]] void refuse_damaged(const std::filesystem::path& file, const Rows& rows, std::uint64_t rows_found);

}  // namespace exactff::jobs
