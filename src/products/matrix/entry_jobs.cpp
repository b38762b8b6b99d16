#include "matrix/entry_jobs.h"

#include <algorithm>
#include <chrono>

#include "kernel/float_environment.h"
#include "kernel/outward.h"
#include "matrix/csv.h"
#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

using kernel::above;
using kernel::below;

// The same patches of a scene with more faces.
std::vector<Selection> of_any_scene(std::span<const Selection> patches) {
  std::vector<Selection> result(patches.begin(), patches.end());
  for (Selection& patch : result) patch.scene = kAnyScene;
  return result;
}

void take_work(ViewFactor& sum, const ViewFactor& f) {
  sum.claim = weaker(sum.claim, f.claim);
  sum.way = std::max(sum.way, f.way);
  sum.accurate = sum.accurate && f.accurate;
  if (sum.limit == Limit::kNone) sum.limit = f.limit;
  sum.cells += f.cells;
  sum.event_cells += f.event_cells;
}

// Zero is exact, so that proved zeros stay zeros.
void add(ViewFactor& sum, const ViewFactor& f) {
  sum.area_from = f.area_from;
  sum.area_to += f.area_to;
  take_work(sum, f);
  if (f.upper == 0.0) return;
  const bool first = sum.upper == 0.0;
  sum.value += f.value;
  sum.lower = first ? f.lower : std::max(0.0, below(sum.lower + f.lower));
  sum.upper = first ? f.upper : above(sum.upper + f.upper);
}

// f is a part of the sum.
void subtract(ViewFactor& sum, const ViewFactor& f) {
  sum.area_to = std::max(0.0, sum.area_to - f.area_to);
  take_work(sum, f);
  if (f.upper == 0.0) return;
  sum.value -= f.value;
  sum.lower = below(sum.lower - f.upper);
  sum.upper = above(sum.upper - f.lower);
}

void clamp(ViewFactor& sum) {
  sum.lower = std::clamp(sum.lower, 0.0, 1.0);
  sum.upper = std::clamp(sum.upper, 0.0, 1.0);
  sum.value = std::clamp(sum.value, sum.lower, sum.upper);
}

// Also where rows are equal, and so one pair gives several entries.
ViewFactor factor_of(const view_factors::Pairs& pairs, std::size_t entry) {
  ViewFactor result;
  pairs.compute(pairs.pair_of(entry), [&](std::size_t of, const ViewFactor& f) {
    if (of == entry) result = f;
  });
  return result;
}

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
  if (options.backs) {
    with_backs_ = with_backs(scene);
    for (const auto& patch : {with_backs_->backs, with_backs_->both, with_backs_->fronts}) {
      if (patch) parts_.push_back(*patch);
    }
    to_backs_.emplace(with_backs_->scene, of_any_scene(from), parts_, options.factors);
  }
  if (options.open) {
    with_sky_ = with_sky(scene);
    to_sky_.emplace(with_sky_->scene, of_any_scene(from), std::span(&with_sky_->sky, 1), options.factors,
                    view_factors::Columns::kSurroundings);
  }
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

// In the scenes made for this, no entry is the transpose of another: the patches of the rows are not among the columns.
ViewFactor EntryJobs::factor_to_backs(std::size_t row) const {
  ViewFactor sum;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    const bool is_fronts = with_backs_->fronts && parts_[part] == *with_backs_->fronts;
    const ViewFactor f = factor_of(*to_backs_, row * parts_.size() + part);
    is_fronts ? subtract(sum, f) : add(sum, f);
  }
  clamp(sum);
  sum.area_from = pairs_.area_from(row);  // also if there is no back
  return sum;
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
  if (to_backs_ && further < from_.size()) {
    take(entries.front(), factor_to_backs(row));
  } else if (pairs_.is_enclosed(row)) {
    take(entries.front(), {.area_from = pairs_.area_from(row)});
  } else {
    take(entries.front(), factor_of(*to_sky_, row));
  }
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
