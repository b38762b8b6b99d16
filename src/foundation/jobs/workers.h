// Threads that compute rows. Their owner decides which rows, and what happens with the results.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "jobs/blocks.h"
#include "jobs/rows.h"

namespace exactff::jobs {

struct SlowRow {
  std::uint64_t row = 0;
  double seconds = 0.0;
};

// Finished rows, as lines.
struct Finished {
  Range range;
  std::string lines;
  std::vector<SlowRow> slow;
};

// Hands out the rows that remain to be computed, in order, in pieces of at most a chunk.
class Schedule {
 public:
  // `done` must be sorted by row, and no block may cross the bounds of a chunk.
  Schedule(const Rows& rows, std::span<const Block> done);

  // From any thread. Nothing if all rows have been handed out.
  [[nodiscard]] std::optional<Range> next();
  // How many rows remained at the start.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }

 private:
  [[nodiscard]] std::optional<Range> advance();

  std::mutex mutex_;
  const Plan plan_;
  std::vector<Range> done_;
  std::size_t next_done_ = 0;
  std::uint64_t position_;
  std::uint64_t rows_ = 0;
};

class Workers {
 public:
  using Take = std::function<std::optional<Range>()>;  // may wait; nothing if no more are left
  using Deliver = std::function<void(Finished)>;

  // Starts the threads. They call `take`, `deliver` and `hooks.cancelled`. Finished rows are delivered at least every
  // second. `rows` and `hooks` must outlive this object.
  Workers(const Rows& rows, int threads, const RowHooks& hooks, Take take, Deliver deliver);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // Makes every thread finish the row in hand, deliver what it has, and end.
  void stop() { stop_ = true; }
  [[nodiscard]] bool stopped() const { return stop_; }
  // True once every thread has ended.
  [[nodiscard]] bool wait_for(std::chrono::milliseconds time);
  // Rethrows what was thrown in a thread. Throws Cancelled if the hooks requested it.
  void rethrow() const;

 private:
  void work();
  void compute(Range range);
  void keep(std::exception_ptr failure);
  [[nodiscard]] bool must_stop();

  const Rows& rows_;
  const RowHooks& hooks_;
  const Take take_;
  const Deliver deliver_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t at_work_ = 0;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

}  // namespace exactff::jobs
