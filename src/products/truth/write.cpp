// From a request to its truth file.
//
// 1. Check the request, and that no other work would be destroyed: the file and its journal.
// 2. Read from the journal which rows are done. Distribute the others by chunks to any idle worker: threads of this
//    process, and other processes if there is a team.
// 3. Append finished rows to the journal at once, in any order. Make it durable every second.
// 4. When every row is in the journal, write the file in order under a temporary name and rename it. Then remove the
//    journal.
#include <memory>
#include <utility>

#include "files/file.h"
#include "jobs/compute.h"
#include "jobs/team.h"
#include "kernel/float_environment.h"
#include "truth/rows.h"
#include "truth/team.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;
using files::File;

void add_rows(const File& file, std::uint64_t offset, Tally& tally) {
  constexpr std::size_t kPieceBytes = 1 << 20;
  for (std::string text = file.read(offset, kPieceBytes); !text.empty(); text = file.read(offset, kPieceBytes)) {
    tally.add(text);
    offset += text.size();
  }
}

Summary account_of(const fs::path& path, const Rows& rows) {
  const File file(path, File::Mode::kRead);
  Tally tally;
  if (rows.plan().shard.count > 1) {
    jobs::require_shard_file(file, rows, [&](const std::string& text) { tally.add(text); });
  } else {
    add_rows(file, jobs::require_head(file, rows), tally);
  }
  if (!tally.whole() || tally.rows() != rows.shard_rows()) jobs::refuse_damaged(path, rows, tally.rows());
  Summary summary;
  summary.rows = summary.resumed = tally.rows();
  summary.rows_by_status = tally.by_status();
  return summary;
}

}  // namespace

Summary write(Request request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks,
              jobs::Team* team) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(std::move(request));
  files::require_not_read(file, rows.request().scene->files());
  jobs::require_free(file, existing);
  if (jobs::is_complete(file, existing)) return account_of(file, rows);
  Summary summary;
  summary.rows = rows.shard_rows();
  jobs::RowJournal journal(file, rows, existing, hooks);
  jobs::compute_missing(rows, journal, team, hooks, summary);
  Tally tally;
  jobs::write_rows(rows, journal, file, hooks,
                   [&](jobs::Range range, const std::string& text) { return tally.add_rows(text, range.rows); });
  journal.remove();
  summary.rows_by_status = tally.by_status();
  return summary;
}

Summary write(Request request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks) {
  return write(std::move(request), file, existing, hooks, nullptr);
}

int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks) {
  return jobs::follow(
      team, [&] { return std::make_unique<Rows>(request()); }, hooks);
}

}  // namespace exactff::truth
