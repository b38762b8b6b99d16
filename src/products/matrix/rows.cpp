#include "matrix/rows.h"

#include <algorithm>
#include <utility>

#include "files/file.h"
#include "files/parallel.h"
#include "jobs/compute.h"
#include "jobs/team.h"
#include "kernel/float_environment.h"
#include "matrix/columns.h"
#include "matrix/team.h"
#include "text/escape.h"
#include "text/refuse.h"

namespace exactff::matrix {
namespace {

namespace fs = std::filesystem;

// Jobs take from microseconds to minutes. Small chunks share them out evenly; as many as this cost little.
constexpr std::uint64_t kChunks = 4096;
constexpr std::uint64_t kLargestChunk = 64;

Request require_valid(Request request) {
  jobs::require_shard(request.shard);
  const bool has_columns = !request.to.empty() || request.options.backs || request.options.open;
  if (request.scene == nullptr || request.from.empty() || !has_columns) {
    text::refuse(std::string("the matrix has no ") + (has_columns ? "rows" : "columns"), "there is nothing to compute",
                 "name patches by --from and --to");
  }
  return request;
}

class EntryComputer : public jobs::Rows::Computer {
 public:
  explicit EntryComputer(const EntryJobs& entries) : entries_(entries) {}
  void append(std::uint64_t row, std::string& text) override {
    entries_.compute(row, [&](std::size_t number, const ViewFactor& f) {
      text += std::to_string(number) + ',';
      entries_.describe(number, entry_);
      entry_.factor = f;
      columns().append_csv(entry_, text);
    });
  }

 private:
  const EntryJobs& entries_;
  Entry entry_;
};

}  // namespace

Rows::Rows(Request request)
    : request_(require_valid(std::move(request))),
      entries_(*request_.scene, request_.from, request_.to, request_.options) {
  const std::uint64_t count = entries_.count();
  const auto chunk = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count / kChunks, 1, kLargestChunk));
  const int threads = request_.options.threads > 0 ? request_.options.threads : files::usable_threads();
  plan_ = {{.command = "matrix", .row = "pair", .rows = "pairs"}, count, chunk, request_.shard, threads};
  numbered_ = true;
  about_ = head_of(*request_.scene, request_.from, request_.to, request_.options.factors,
                   {request_.options.backs, request_.options.open, entries_.has_buried()});
  columns_ = columns().columns();
}

std::vector<std::uint64_t> Rows::lines_of(std::uint64_t row) const {
  const std::vector<std::size_t> entries = entries_.entries_of(row);
  return {entries.begin(), entries.end()};
}

std::unique_ptr<Rows::Computer> Rows::computer() const { return std::make_unique<EntryComputer>(entries_); }

// --- Files ---

jobs::Summary write(const Request& request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks,
                    jobs::Team* team) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(request);
  files::require_not_read(file, request.scene->files());
  return jobs::write(rows, file, existing, hooks, team);
}

jobs::Summary write(const Request& request, const fs::path& file, jobs::Existing existing,
                    const jobs::RowHooks& hooks) {
  return write(request, file, existing, hooks, nullptr);
}

int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks) {
  return jobs::follow(
      team, [&] { return std::make_unique<Rows>(request()); }, hooks);
}

namespace {

bool are_names(const Scene& scene, const std::vector<Selection>& patches, const std::vector<std::string>& read) {
  return std::ranges::equal(patches, read, [&](const Selection& patch, const std::string& name) {
    return text::csv_field(scene.name_of(patch)) == text::csv_field(name);
  });
}

}  // namespace

Matrix read(const Request& request, const fs::path& file) { return matrix_of(request, read_named(file)); }

Matrix matrix_of(const Request& request, NamedMatrix named) {
  const bool same = are_names(*request.scene, request.from, named.from) &&
                    are_names(*request.scene, request.to, named.to) && named.back.empty() != request.options.backs &&
                    named.open.empty() != request.options.open;
  if (!same) {
    text::refuse(named.file, "holds other rows or columns than those that are asked for",
                 "its entries would be taken for others", "compute the matrix again, or name another file");
  }
  return {{request.from, request.to, std::move(named.entries)},
          std::move(named.back),
          std::move(named.open),
          std::move(named.buried)};
}

}  // namespace exactff::matrix
