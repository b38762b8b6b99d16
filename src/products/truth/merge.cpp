#include "exactff/truth.h"
#include "files/file.h"
#include "jobs/shards.h"
#include "kernel/float_environment.h"
#include "truth/rows.h"

namespace exactff::truth {

Summary merge(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& file,
              jobs::Existing existing, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  files::require_not_read(file, paths);
  jobs::require_free(file, existing == jobs::Existing::kReplace ? existing : jobs::Existing::kRefuse);
  const jobs::MergedShards shards = jobs::read_shards(paths, kKind, hooks);
  files::WholeFile whole(file);
  whole.append(shards.head);
  Tally tally;
  shards.for_each_chunk([&](jobs::Range range, const std::string& text) {
    whole.append(text);
    return tally.add_rows(text, range.rows);
  });
  whole.commit();
  Summary summary;
  summary.rows = tally.rows();
  summary.rows_by_status = tally.by_status();
  return summary;
}

}  // namespace exactff::truth
