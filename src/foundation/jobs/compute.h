// From rows to a journal that holds all of them, and from there to files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "exactff/jobs.h"
#include "jobs/journal.h"
#include "jobs/rows.h"
#include "jobs/team.h"

namespace exactff::jobs {

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
