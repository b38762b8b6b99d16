#include "matrix/entry_jobs.h"

#include <algorithm>

#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

bool some_is_buried(const view_factors::Pairs& pairs, std::size_t rows) {
  for (std::size_t row = 0; row < rows; ++row) {
    if (pairs.exposed_share(row).centre != 1.0 || pairs.exposed_share(row).radius != 0.0) return true;
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

}  // namespace

EntryJobs::EntryJobs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                     const Options& options)
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

std::size_t EntryJobs::count() const { return pairs_.count() + (width_ - to_.size()) * from_.size(); }

std::vector<std::size_t> EntryJobs::entries_of(std::size_t job) const {
  if (job >= pairs_.count()) {
    const std::size_t further = job - pairs_.count();  // back of every row, then open, then buried
    return {further % from_.size() * width_ + to_.size() + further / from_.size()};
  }
  std::vector<std::size_t> entries = pairs_.entries_of(job);
  for (std::size_t& entry : entries) entry = entry / to_.size() * width_ + entry % to_.size();
  return entries;
}

void EntryJobs::compute(std::size_t job, const std::function<void(std::size_t, const ViewFactor&)>& take) const {
  const std::vector<std::size_t> entries = entries_of(job);
  if (job < pairs_.count()) {
    std::size_t next = 0;
    pairs_.compute(job, [&](std::size_t, const ViewFactor& f) { take(entries[next++], f); });
    return;
  }
  const std::size_t row = entries.front() / width_;
  ViewFactor factor = computed(kind_of(entries.front() % width_), row);
  factor.area_from = pairs_.area_from(row);
  take(entries.front(), factor);
}

ViewFactor EntryJobs::computed(Column column, std::size_t row) const {
  switch (column) {
    case Column::kOfBacks:
      return to_backs_->of_row(row);
    case Column::kOfSky:
      return to_sky_->of_row(row);
    default:
      return buried_share(pairs_.exposed_share(row));
  }
}

EntryJobs::Column EntryJobs::kind_of(std::size_t column) const {
  if (column < to_.size()) return Column::kOfPatch;
  if (has_buried_ && column + 1 == width_) return Column::kOfBuried;
  return to_backs_ && column == to_.size() ? Column::kOfBacks : Column::kOfSky;
}

std::string EntryJobs::name_of_column(std::size_t column) const {
  const Column kind = kind_of(column);
  if (kind == Column::kOfPatch) return scene_.name_of(to_[column]);
  return std::string(kind == Column::kOfBacks ? kBack : kind == Column::kOfSky ? kOpen : kBuried);
}

std::string EntryJobs::name(std::size_t job) const {
  const std::size_t entry = entries_of(job).front();
  return "from " + text::in_quotes(scene_.name_of(from_[entry / width_])) + " to " +
         text::in_quotes(name_of_column(entry % width_));
}

void EntryJobs::describe(std::size_t number, Entry& entry) const {
  const std::size_t column = number % width_;
  entry.from = scene_.name_of(from_[number / width_]);
  entry.to = name_of_column(column);
  entry.has_area_to = kind_of(column) == Column::kOfPatch || kind_of(column) == Column::kOfBacks;
}

}  // namespace exactff::matrix
