#include "jobs/workers.h"

#include <algorithm>

#include "exactff/progress.h"

namespace exactff::jobs {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kLongestUndelivered = std::chrono::seconds(1);

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

}  // namespace

Schedule::Schedule(const Rows& rows, std::span<const Block> done)
    : plan_(rows.plan()), position_((plan_.shard.number - 1) * plan_.chunk) {
  for (const Block& block : done) done_.push_back(block.range);
  rows_ = plan_.shard_rows();
  for (const Range& range : done_) rows_ -= range.rows;
}

std::optional<Range> Schedule::next() {
  const std::lock_guard lock(mutex_);
  return advance();
}

std::optional<Range> Schedule::advance() {
  while (position_ < plan_.count) {
    const std::uint64_t chunk_end = std::min(plan_.count, (position_ / plan_.chunk + 1) * plan_.chunk);
    const bool more_done = next_done_ < done_.size();
    if (more_done && done_[next_done_].first == position_) {
      position_ = done_[next_done_++].end();
    } else {
      const std::uint64_t end = more_done ? std::min(chunk_end, done_[next_done_].first) : chunk_end;
      const Range range{position_, static_cast<std::uint32_t>(end - position_)};
      position_ = end;
      if (position_ == chunk_end) position_ += (plan_.shard.count - 1) * plan_.chunk;
      return range;
    }
    if (position_ == chunk_end) position_ += (plan_.shard.count - 1) * plan_.chunk;
  }
  return std::nullopt;
}

Workers::Workers(const Rows& rows, int threads, const RowHooks& hooks, Take take, Deliver deliver)
    : rows_(rows), hooks_(hooks), take_(std::move(take)), deliver_(std::move(deliver)) {
  try {
    for (int i = 0; i < threads; ++i) {
      {
        const std::lock_guard lock(mutex_);
        ++at_work_;
      }
      threads_.emplace_back([this] { work(); });
    }
  } catch (...) {  // a thread could not be started: the others stop, too
    stop();
    threads_.clear();
    throw;
  }
}

Workers::~Workers() { stop(); }

void Workers::work() {
  const Hooks polled{{}, hooks_.cancelled};
  const HooksOfThread within_rows(polled);
  try {
    while (!must_stop()) {
      const std::optional<Range> range = take_();
      if (!range) break;
      compute(*range);
    }
  } catch (...) {
    keep(std::current_exception());
  }
  const std::lock_guard lock(mutex_);
  if (--at_work_ == 0) ended_.notify_all();
}

bool Workers::must_stop() {
  if (!stop_ && hooks_.cancelled && hooks_.cancelled()) throw Cancelled();
  return stop_;
}

namespace {

// Rows that are finished and not yet delivered.
class Batch {
 public:
  Batch(std::uint64_t first, const Workers::Deliver& deliver) : deliver_(deliver) { finished_.range.first = first; }

  void add(std::string_view line) {
    finished_.lines += line;
    ++finished_.range.rows;
    if (Clock::now() - since_ >= kLongestUndelivered) deliver();
  }
  void add_slow(SlowRow slow) { finished_.slow.push_back(slow); }
  void deliver() {
    Finished whole{{finished_.range.end(), 0}, {}, {}};
    std::swap(whole, finished_);
    since_ = Clock::now();
    if (whole.range.rows > 0) deliver_(std::move(whole));
  }

 private:
  const Workers::Deliver& deliver_;
  Finished finished_;
  Clock::time_point since_ = Clock::now();
};

}  // namespace

void Workers::compute(Range range) {
  Batch batch(range.first, deliver_);
  std::string line;
  const std::unique_ptr<Rows::Computer> computer = rows_.computer();
  try {
    for (std::uint64_t row = range.first; row < range.end() && !must_stop(); ++row) {
      const auto start = Clock::now();
      line.clear();
      computer->append(row, line);
      const double seconds = seconds_between(start, Clock::now());
      if (seconds >= hooks_.slow_seconds) batch.add_slow({row, seconds});
      batch.add(line);
    }
  } catch (...) {
    batch.deliver();
    throw;
  }
  batch.deliver();
}

void Workers::keep(std::exception_ptr failure) {
  stop();
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(failure);
}

bool Workers::wait_for(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, time, [this] { return at_work_ == 0; });
}

void Workers::rethrow() const {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace exactff::jobs
