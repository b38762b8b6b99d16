// From rows to a journal that holds all of them, and from there to a table.
//
// 1. Check that no other work would be destroyed: the file and its journal.
// 2. Read from the journal which rows are done. Distribute the others by chunks to any idle worker: threads of this
//    process, and other processes if there is a team.
// 3. Append finished rows to the journal at once, in any order. Make it durable every second.
// 4. When every row is in the journal, write the file in order under a temporary name and rename it. Then remove the
//    journal.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/jobs.h"
#include "jobs/journal.h"
#include "jobs/rows.h"
#include "jobs/team.h"

namespace exactff::jobs {

// Computes the table, or the shard of it, by way of a journal, and writes it as CSV: on threads of this process, and on
// the other processes if there is a team, whose leader this must be. With a complete file and `existing` to continue,
// only reads it. `see` gets all rows. Throws InputError if the file or the journal is unusable, or if nothing can be
// written; throws Cancelled if the hooks cancel. Whatever is thrown, finished rows are in the journal.
Summary write(const Rows& rows, const std::filesystem::path& file, Existing existing, const RowHooks& hooks, Team* team,
              const See& see = {});

}  // namespace exactff::jobs
