// The CSV file of a matrix by way of a journal. Pairs are finished in any order; the file is made when all are there.
#include <algorithm>
#include <memory>
#include <utility>

#include "files/file.h"
#include "jobs/compute.h"
#include "jobs/shards.h"
#include "jobs/team.h"
#include "kernel/float_environment.h"
#include "matrix/rows.h"
#include "matrix/team.h"
#include "text/escape.h"
#include "text/refuse.h"

namespace exactff::matrix {
namespace {

namespace fs = std::filesystem;

void require_csv_head(const files::File& file, const Rows& rows) {
  const std::string head = rows.csv_head();
  jobs::require_same_head(file.path(), jobs::read_head(file).value_or(file.read(0, head.size())), head);
}

jobs::Summary account_of(const fs::path& path, const Rows& rows) {
  const files::File file(path, files::File::Mode::kRead);
  if (rows.plan().shard.count > 1) {
    jobs::require_shard_file(file, rows, [](const std::string&) {});
  } else {
    require_csv_head(file, rows);
    (void)read(rows.request(), path);
  }
  jobs::Summary summary;
  summary.rows = summary.resumed = rows.shard_rows();
  return summary;
}

void write_in_order(const Rows& rows, const jobs::RowJournal& journal, const fs::path& file,
                    const jobs::RowHooks& hooks) {
  EntryLines lines;
  jobs::for_each_chunk(rows, journal, hooks, [&](jobs::Range range, const std::string& text) {
    return rows.may_be_text_of(range, text) && lines.add(text);
  });
  files::WholeFile whole(file, jobs::advice_while_in_journal(journal));
  whole.append(rows.csv_head());
  whole.append(lines.in_order());
  whole.commit();
}

std::vector<std::string> names_of(const Scene& scene, const std::vector<Selection>& patches) {
  std::vector<std::string> names;
  for (const Selection& patch : patches) names.push_back(text::csv_field(scene.name_of(patch)));
  return names;
}

bool are_names(const std::vector<std::string>& fields, const std::vector<std::string>& read) {
  return std::ranges::equal(fields, read, {}, {}, [](const std::string& name) { return text::csv_field(name); });
}

}  // namespace

jobs::Summary write(const Request& request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks,
                    jobs::Team* team) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(request);
  files::require_not_read(file, request.scene->files());
  jobs::require_free(file, existing);
  if (jobs::is_complete(file, existing)) return account_of(file, rows);
  jobs::Summary summary;
  summary.rows = rows.shard_rows();
  jobs::RowJournal journal(file, rows, existing, hooks);
  jobs::compute_missing(rows, journal, team, hooks, summary);
  if (rows.plan().shard.count > 1) {
    jobs::write_rows(rows, journal, file, hooks,
                     [&](jobs::Range range, const std::string& text) { return rows.may_be_text_of(range, text); });
  } else {
    write_in_order(rows, journal, file, hooks);
  }
  journal.remove();
  return summary;
}

jobs::Summary write(const Request& request, const fs::path& file, jobs::Existing existing,
                    const jobs::RowHooks& hooks) {
  return write(request, file, existing, hooks, nullptr);
}

int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks) {
  return jobs::follow(
      team, [&] { return std::make_unique<Rows>(request()); }, hooks);
}

jobs::Summary merge(const std::vector<fs::path>& paths, const fs::path& file, jobs::Existing existing,
                    const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  files::require_not_read(file, paths);
  jobs::require_free(file, existing == jobs::Existing::kReplace ? existing : jobs::Existing::kRefuse);
  const jobs::MergedShards shards = jobs::read_shards(paths, kKind, hooks);
  EntryLines lines;
  shards.for_each_chunk([&](jobs::Range, const std::string& text) { return lines.add(text); });
  const std::string head = head_without_jobs(shards.head), entries = lines.in_order();
  if (head.empty() || entries.empty()) {
    text::refuse(paths.front(), "and the other shards do not hold each entry of a matrix once", "every entry is needed",
                 "compute them again");
  }
  files::WholeFile whole(file);
  whole.append(head);
  whole.append(entries);
  whole.commit();
  jobs::Summary summary;
  summary.rows = shards.rows;
  return summary;
}

Matrix read(const Request& request, const fs::path& file) {
  Table table = read_csv(file);
  const bool same = are_names(names_of(*request.scene, request.from), table.from) &&
                    are_names(names_of(*request.scene, request.to), table.to) &&
                    table.back.empty() != request.options.backs && table.open.empty() != request.options.open;
  if (!same) {
    text::refuse(file, "holds other rows or columns than those that are asked for",
                 "its entries would be taken for others", "compute the matrix again, or name another file");
  }
  return {{request.from, request.to, std::move(table.entries)},
          std::move(table.back),
          std::move(table.open),
          std::move(table.buried)};
}

}  // namespace exactff::matrix
