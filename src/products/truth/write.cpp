// From a request to its truth file, and from shards.
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

// The summary, of what `work` does; it gives all rows to the tally.
template <class Work>
Summary counted(const Work& work) {
  Tally tally;
  Summary summary{work([&](std::string_view text) { tally.add(text); }), {}};
  summary.rows_by_status = tally.by_status();
  return summary;
}

}  // namespace

Summary write(Request request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks,
              jobs::Team* team) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(std::move(request));
  files::require_not_read(file, rows.request().scene->files());
  return counted([&](const jobs::See& see) { return jobs::write(rows, file, existing, hooks, team, see); });
}

Summary merge(const std::vector<fs::path>& shards, const fs::path& file, jobs::Existing existing,
              const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  return counted([&](const jobs::See& see) { return jobs::merge(shards, file, existing, hooks, see); });
}

Summary write(Request request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks) {
  return write(std::move(request), file, existing, hooks, nullptr);
}

int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks) {
  return jobs::follow(
      team, [&] { return std::make_unique<Rows>(request()); }, hooks);
}

}  // namespace exactff::truth
