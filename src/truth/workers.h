// Threads that compute rows: which rows, and what becomes of them, is their owner's business.
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

#include "truth/blocks.h"
#include "truth/rows.h"

namespace exactff::truth {

struct SlowRow {
  std::uint64_t row = 0;
  double seconds = 0.0;
};

// Rows done, as lines.
struct Finished {
  Range range;
  std::string lines;
  std::vector<SlowRow> slow;
};

// The rows that are still to be done, in order, in pieces of a chunk at most.
class Schedule {
 public:
  // `done` by rising row, none across the bounds of a chunk.
  Schedule(const Rows& rows, std::span<const Block> done);

  // From any thread; nothing when all have been given out.
  [[nodiscard]] std::optional<Range> next();
  // Rows that were not done at first.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }

 private:
  [[nodiscard]] std::optional<Range> advance();

  std::mutex mutex_;
  const std::uint64_t count_;
  const Shard shard_;
  std::vector<Range> done_;
  std::size_t next_done_ = 0;
  std::uint64_t position_;
  std::uint64_t rows_ = 0;
};

class Workers {
 public:
  using Take = std::function<std::optional<Range>()>;  // may wait; nothing when there is no more
  using Deliver = std::function<void(Finished)>;

  // Starts the threads. `take`, `deliver` and `hooks.cancelled` are called from them; what is finished is delivered
  // every second at least. `rows` and `hooks` must outlive this.
  Workers(const Rows& rows, int threads, const Hooks& hooks, Take take, Deliver deliver);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // Every thread delivers what it has after the row in hand, and ends.
  void stop() { stop_ = true; }
  [[nodiscard]] bool stopped() const { return stop_; }
  // True once every thread has ended.
  [[nodiscard]] bool wait_for(std::chrono::milliseconds time);
  // Throws what was thrown in a thread, or study::Cancelled if the hooks said so.
  void rethrow() const;

 private:
  void work();
  void compute(Range range);
  void keep(std::exception_ptr failure);
  [[nodiscard]] bool must_stop();

  const Rows& rows_;
  const Hooks& hooks_;
  const Take take_;
  const Deliver deliver_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t at_work_ = 0;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

}  // namespace exactff::truth
