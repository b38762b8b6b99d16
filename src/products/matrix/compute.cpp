// A matrix, job by job: at once, or by way of a journal.
#include "jobs/compute.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "files/file.h"
#include "files/parallel.h"
#include "jobs/rows.h"
#include "kernel/float_environment.h"
#include "matrix/rows.h"
#include "matrix/surroundings.h"
#include "text/escape.h"
#include "text/refuse.h"
#include "text/text_lines.h"
#include "view_factors/pairs.h"

namespace exactff::matrix {
namespace {

namespace fs = std::filesystem;

bool some_is_buried(const view_factors::Pairs& pairs, std::size_t rows) {
  for (std::size_t row = 0; row < rows; ++row) {
    if (!is_whole_share(pairs.exposed_share(row))) return true;
  }
  return false;
}

ViewFactor buried_share(const kernel::Disc& exposed) {
  if (exposed.radius == 0.0 && (exposed.centre == 1.0 || exposed.centre == 0.0)) {
    const double buried = 1.0 - exposed.centre;
    return {
        .value = buried, .lower = buried, .upper = buried, .claim = buried == 0.0 ? Claim::kZero : Claim::kCertified};
  }
  const kernel::Disc share = kernel::Disc{.centre = 1.0} - exposed;
  const double lower = std::clamp(lower_end(share), 0.0, 1.0), upper = std::clamp(upper_end(share), 0.0, 1.0);
  return {.value = std::clamp(share.centre, lower, upper), .lower = lower, .upper = upper, .claim = Claim::kCertified};
}

// Entries are numbered row by row, as in the CSV file: to patches, then (back), (open), (buried).
class EntryJobs {
 public:
  // Throws what compute throws. Keeps a reference to the scene.
  EntryJobs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to, const Options& options)
      : scene_(scene),
        from_(from.begin(), from.end()),
        to_(to.begin(), to.end()),
        pairs_(scene, from, to, options.factors),
        has_buried_(some_is_buried(pairs_, from.size())),
        width_(to.size() + (options.backs ? 1 : 0) + (options.open ? 1 : 0) + (has_buried_ ? 1 : 0)) {
    if (from.empty()) return;
    if (options.backs) to_backs_.emplace(scene, from, options.factors);
    if (options.open) to_sky_.emplace(scene, from, options.factors, pairs_);
  }

  [[nodiscard]] std::size_t count() const { return pairs_.count() + (width_ - to_.size()) * from_.size(); }
  [[nodiscard]] std::size_t width() const { return width_; }     // entries of a row
  [[nodiscard]] bool has_buried() const { return has_buried_; }  // a part of some row is

  // The entries that a job gives.
  [[nodiscard]] std::vector<std::size_t> entries_of(std::size_t job) const {
    if (job >= pairs_.count()) {
      const std::size_t further = job - pairs_.count();  // back of every row, then open, then buried
      return {further % from_.size() * width_ + to_.size() + further / from_.size()};
    }
    std::vector<std::size_t> entries = pairs_.entries_of(job);
    for (std::size_t& entry : entries) entry = entry / to_.size() * width_ + entry % to_.size();
    return entries;
  }

  // Calls take(entry, factor) in the order of entries_of. From any thread.
  template <class Take>
  void compute(std::size_t job, const Take& take) const {
    const std::vector<std::size_t> entries = entries_of(job);
    if (job < pairs_.count()) {
      std::size_t next = 0;
      pairs_.compute(job, [&](std::size_t, const ViewFactor& f) { take(entries[next++], f); });
      return;
    }
    const std::size_t row = entries.front() / width_;
    const Column column = kind_of(entries.front() % width_);
    ViewFactor factor = column == Column::kOfBacks ? to_backs_->of_row(row)
                        : column == Column::kOfSky ? to_sky_->of_row(row)
                                                   : buried_share(pairs_.exposed_share(row));
    factor.area_from = pairs_.area_from(row);
    take(entries.front(), factor);
  }

  // "from 'floor' to 'light'", for messages.
  [[nodiscard]] std::string name(std::size_t job) const {
    const std::size_t entry = entries_of(job).front();
    return "from " + text::in_quotes(scene_.name_of(from_[entry / width_])) + " to " +
           text::in_quotes(name_of_column(entry % width_));
  }

  // Sets all but the factor.
  void describe(std::size_t number, Entry& entry) const {
    const std::size_t column = number % width_;
    entry.from = scene_.name_of(from_[number / width_]);
    entry.to = name_of_column(column);
    entry.has_area_to = kind_of(column) == Column::kOfPatch || kind_of(column) == Column::kOfBacks;
  }

  // Where a matrix has it.
  [[nodiscard]] ViewFactor& place_in(Matrix& matrix, std::size_t entry) const {
    const std::size_t row = entry / width_, column = entry % width_;
    const Column kind = kind_of(column);
    if (kind == Column::kOfPatch) return matrix.factors.entries[row * to_.size() + column];
    return (kind == Column::kOfBacks ? matrix.back : kind == Column::kOfSky ? matrix.open : matrix.buried)[row];
  }

 private:
  enum class Column { kOfPatch, kOfBacks, kOfSky, kOfBuried };
  [[nodiscard]] Column kind_of(std::size_t column) const {
    if (column < to_.size()) return Column::kOfPatch;
    if (has_buried_ && column + 1 == width_) return Column::kOfBuried;
    return to_backs_ && column == to_.size() ? Column::kOfBacks : Column::kOfSky;
  }
  [[nodiscard]] std::string name_of_column(std::size_t column) const {
    const Column kind = kind_of(column);
    if (kind == Column::kOfPatch) return scene_.name_of(to_[column]);
    return std::string(kind == Column::kOfBacks ? kBack : kind == Column::kOfSky ? kOpen : kBuried);
  }

  const Scene& scene_;
  const std::vector<Selection> from_, to_;
  view_factors::Pairs pairs_;
  bool has_buried_;
  std::size_t width_;
  std::optional<BackFactors> to_backs_;
  std::optional<OpenFactors> to_sky_;
};

}  // namespace

Matrix compute(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
               const Options& options, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const EntryJobs jobs(scene, from, to, options);
  Matrix result{{{from.begin(), from.end()}, {to.begin(), to.end()}, {}}, {}, {}, {}};
  result.factors.entries.resize(from.size() * to.size());
  if (options.backs) result.back.resize(from.size());
  if (options.open) result.open.resize(from.size());
  if (jobs.has_buried()) result.buried.resize(from.size());
  const files::Loop loop{
      .count = jobs.count(), .threads = options.threads, .stage = "view factors", .name = [&](std::size_t job) {
        return jobs.name(job);
      }};
  const files::Body body = [&](std::size_t job) {
    jobs.compute(job, [&](std::size_t entry, const ViewFactor& f) { jobs.place_in(result, entry) = f; });
  };
  files::parallel_for(loop, hooks, [&] { return body; });
  return result;
}

// --- By way of a journal ---

namespace {

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

// Each job gives one or two entries, that is, lines of the table.
class Rows : public jobs::Rows {
 public:
  // Throws what compute throws, and InputError if there is nothing to compute.
  explicit Rows(Request request)
      : request_(require_valid(std::move(request))),
        entries_(*request_.scene, request_.from, request_.to, request_.options) {
    const std::uint64_t count = entries_.count();
    const auto chunk = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count / kChunks, 1, kLargestChunk));
    const int threads = request_.options.threads > 0 ? request_.options.threads : files::usable_threads();
    plan_ = {{.command = "matrix", .row = "pair", .rows = "pairs"}, count, chunk, request_.shard, threads};
    numbered_ = true;
    about_ = head_of(*request_.scene, request_.from, request_.to, request_.options.factors,
                     {request_.options.backs, request_.options.open, entries_.has_buried()});
    columns_ = matrix::columns().columns();
  }

  [[nodiscard]] std::string name(std::uint64_t row) const override { return entries_.name(row); }
  [[nodiscard]] std::vector<std::uint64_t> lines_of(std::uint64_t row) const override {
    const std::vector<std::size_t> entries = entries_.entries_of(row);
    return {entries.begin(), entries.end()};
  }
  [[nodiscard]] std::uint64_t line_count() const override { return request_.from.size() * entries_.width(); }
  [[nodiscard]] std::unique_ptr<Computer> computer() const override {
    return std::make_unique<EntryComputer>(entries_);
  }

 private:
  class EntryComputer : public Computer {
   public:
    explicit EntryComputer(const EntryJobs& entries) : entries_(entries) {}
    void append(std::uint64_t row, std::string& text) override {
      entries_.compute(row, [&](std::size_t number, const ViewFactor& f) {
        text += std::to_string(number) + ',';
        entries_.describe(number, entry_);
        static_cast<ViewFactor&>(entry_) = f;
        matrix::columns().append_csv(entry_, text);
      });
    }

   private:
    const EntryJobs& entries_;
    Entry entry_;
  };

  Request request_;
  EntryJobs entries_;
};

bool are_names(const Scene& scene, const std::vector<Selection>& patches, const std::vector<std::string>& read) {
  return std::ranges::equal(patches, read, [&](const Selection& patch, const std::string& name) {
    return text::csv_field(scene.name_of(patch)) == text::csv_field(name);
  });
}

}  // namespace

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
