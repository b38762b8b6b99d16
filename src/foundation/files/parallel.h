// Threads: how many to use, a pool of them, and loops over independent indices.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "exactff/jobs.h"

namespace exactff::files {

// The number of processors that this process may use. A batch system, taskset or mpirun may have given it fewer than
// the machine has.
[[nodiscard]] int usable_threads();

// Throws Cancelled if the hooks request it, these or those of the thread.
void require_not_cancelled(const Hooks& hooks);

// Threads that work, while the thread that made them waits, reports progress and asks whether to cancel.
class WorkerPool {
  using Clock = std::chrono::steady_clock;

 public:
  // What a thread says to the others. In a cache line of its own, since it is written for every step.
  class alignas(64) Worker {
   public:
    explicit Worker(WorkerPool& pool) : pool_(pool) {}

    // Whether to end. To be asked between steps. Throws Cancelled if the hooks request it.
    [[nodiscard]] bool must_stop();
    [[nodiscard]] bool stopped() const { return pool_.stop_; }  // without asking
    // A step begins; returns the time. It ends when the next one begins, or the work.
    Clock::time_point begin(std::uint64_t step);

   private:
    friend class WorkerPool;
    WorkerPool& pool_;
    std::atomic<std::uint64_t> step_{0};
    std::atomic<Clock::rep> since_{0};  // 0: none
  };
  using Work = std::function<void(Worker& worker)>;

  // Starts the threads, each of which calls `work` once. Whatever it calls asks hooks.cancelled, too, or else that of
  // the calling thread's hooks; it reports no progress. If a thread cannot be started, the others end, and the reason
  // is thrown.
  WorkerPool(int threads, const Hooks& hooks, Work work);
  ~WorkerPool() { stop(); }
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  void stop() { stop_ = true; }  // makes every thread end after its step
  [[nodiscard]] bool stopped() const { return stop_; }
  // True once every thread has ended.
  [[nodiscard]] bool wait_for(std::chrono::milliseconds time);
  // Rethrows what was first thrown in a thread, which has made the others stop.
  void rethrow() const;

  // The step in progress that began first, if it has taken at least this long.
  [[nodiscard]] std::optional<std::uint64_t> slow_step(std::chrono::milliseconds at_least) const;

 private:
  void run(Worker& worker);
  void keep(std::exception_ptr failure);

  Hooks polled_;
  const Work work_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t at_work_ = 0;
  std::exception_ptr failure_;
  std::deque<Worker> workers_;
  std::vector<std::jthread> threads_;
};

inline constexpr std::chrono::milliseconds kSlowStep{1000};  // the time after which Progress names a step

struct Loop {
  std::size_t count = 0;          // of its steps
  int threads = 0;                // 0: usable_threads()
  std::string_view stage;         // of its progress
  std::size_t few = 0;            // so few steps are not worth a thread
  std::size_t largest_block = 1;  // steps that a thread takes at once; more if they are short
  // The name of a step, for Progress::slow. If it is given, threads are used even where one is enough.
  std::function<std::string(std::size_t)> name = {};
};

// What one thread does in a step; holds the thread's memory.
using Body = std::function<void(std::size_t)>;

// Calls make_body() once for each thread, and its result for every index below loop.count. A loop of few steps, or for
// one thread, runs on the calling thread, which reports progress and asks hooks.cancelled after each step, or about 50
// times a second if steps are short. Otherwise, the calling thread only waits, and does so about 50 times a second.
// When all threads have ended, the first exception is rethrown; so is Cancelled. What the bodies call asks as
// WorkerPool says.
void parallel_for(const Loop& loop, const Hooks& hooks, const std::function<Body()>& make_body);

// The same where threads need no memory.
void parallel_for(std::size_t count, int threads, std::string_view stage, const Hooks& hooks, const Body& body);

}  // namespace exactff::files
