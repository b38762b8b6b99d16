#include "matrix/entry_jobs.h"

#include <chrono>

#include "kernel/float_environment.h"
#include "matrix/csv.h"
#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

// What this thread is computing.
class AtWork {
 public:
  AtWork(const EntryJobs& jobs, std::size_t job) : jobs_(jobs), job_(job) { of_thread = this; }
  ~AtWork() { of_thread = nullptr; }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  [[nodiscard]] std::string name() const { return jobs_.name(job_); }

  static thread_local const AtWork* of_thread;

 private:
  const EntryJobs& jobs_;
  const std::size_t job_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
thread_local const AtWork* AtWork::of_thread = nullptr;

}  // namespace

EntryJobs::EntryJobs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                     const Options& options)
    : scene_(scene),
      from_(from.begin(), from.end()),
      to_(to.begin(), to.end()),
      pairs_(scene, from, to, options.factors),
      width_(to.size() + (options.backs ? 1 : 0) + (options.open ? 1 : 0)) {
  if (from.empty()) return;
  if (options.backs) to_backs_.emplace(scene, from, options.factors);
  if (options.open) to_sky_.emplace(scene, from, options.factors, pairs_);
}

std::size_t EntryJobs::count() const {
  return pairs_.count() + (to_backs_ ? from_.size() : 0) + (to_sky_ ? from_.size() : 0);
}

std::vector<std::size_t> EntryJobs::entries_of(std::size_t job) const {
  if (job >= pairs_.count()) {
    const std::size_t further = job - pairs_.count();  // back of every row, then open
    return {further % from_.size() * width_ + to_.size() + further / from_.size()};
  }
  std::vector<std::size_t> entries = pairs_.entries_of(job);
  for (std::size_t& entry : entries) entry = entry / to_.size() * width_ + entry % to_.size();
  return entries;
}

void EntryJobs::compute(std::size_t job, const std::function<void(std::size_t, const ViewFactor&)>& take) const {
  const kernel::StandardArithmetic arithmetic;
  const AtWork at_work(*this, job);
  const std::vector<std::size_t> entries = entries_of(job);
  if (job < pairs_.count()) {
    std::size_t next = 0;
    pairs_.compute(job, [&](std::size_t, const ViewFactor& f) { take(entries[next++], f); });
    return;
  }
  const std::size_t further = job - pairs_.count(), row = further % from_.size();
  ViewFactor factor = to_backs_ && further < from_.size() ? to_backs_->of_row(row) : to_sky_->of_row(row);
  factor.area_from = pairs_.area_from(row);
  take(entries.front(), factor);
}

std::string EntryJobs::slow_of_thread(double seconds) {
  const AtWork* const at_work = AtWork::of_thread;
  return at_work != nullptr && at_work->seconds() >= seconds ? at_work->name() : std::string();
}

std::string EntryJobs::name_of_column(std::size_t column) const {
  if (column < to_.size()) return scene_.name_of(to_[column]);
  return std::string(to_backs_ && column == to_.size() ? kBack : kOpen);
}

std::string EntryJobs::name(std::size_t job) const {
  const std::size_t entry = entries_of(job).front();
  return "from " + text::in_quotes(scene_.name_of(from_[entry / width_])) + " to " +
         text::in_quotes(name_of_column(entry % width_));
}

void EntryJobs::append_csv(std::string& text, std::size_t entry, const ViewFactor& f) const {
  const std::size_t column = entry % width_;
  const bool is_open = to_sky_ && column + 1 == width_;
  add_csv_row(text, scene_.name_of(from_[entry / width_]), name_of_column(column), f,
              is_open ? std::nullopt : std::optional(f.area_to));
}

}  // namespace exactff::matrix
