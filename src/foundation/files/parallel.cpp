#include "files/parallel.h"

#include <sched.h>

#include <algorithm>
#include <utility>

#include "kernel/poll.h"

namespace exactff::files {

int usable_threads() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (::sched_getaffinity(0, sizeof allowed, &allowed) == 0) return std::max(1, CPU_COUNT(&allowed));
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void require_not_cancelled(const Hooks& hooks) {
  if (hooks.cancelled && hooks.cancelled()) throw Cancelled();
  kernel::poll();
}

namespace {

// The hooks of what is called within a loop: without progress, which is that of the loop.
Hooks polled(const Hooks& hooks) {
  const Hooks* const callers = kernel::hooks_of_thread;
  return {{}, hooks.cancelled || callers == nullptr ? hooks.cancelled : callers->cancelled};
}

}  // namespace

// --- the pool ---

bool WorkerPool::Worker::must_stop() {
  if (!pool_.stop_) kernel::poll();
  return pool_.stop_;
}

// No thread sees the new step with the old time.
WorkerPool::Clock::time_point WorkerPool::Worker::begin(std::uint64_t step) {
  const auto now = Clock::now();
  since_.store(0, std::memory_order_relaxed);
  step_.store(step, std::memory_order_release);
  since_.store(now.time_since_epoch().count(), std::memory_order_release);
  return now;
}

std::optional<std::uint64_t> WorkerPool::slow_step(std::chrono::milliseconds at_least) const {
  Clock::rep earliest = (Clock::now() - at_least).time_since_epoch().count();
  std::optional<std::uint64_t> found;
  for (const Worker& worker : workers_) {
    const Clock::rep since = worker.since_.load(std::memory_order_acquire);
    const std::uint64_t step = worker.step_.load(std::memory_order_acquire);
    if (since == 0 || since > earliest || worker.since_.load(std::memory_order_relaxed) != since) continue;
    earliest = since;
    found = step;
  }
  return found;
}

WorkerPool::WorkerPool(int threads, const Hooks& hooks, Work work) : polled_(polled(hooks)), work_(std::move(work)) {
  try {
    for (int i = 0; i < threads; ++i) {
      {
        const std::lock_guard lock(mutex_);
        ++at_work_;
      }
      threads_.emplace_back([this, &worker = workers_.emplace_back(*this)] { run(worker); });
    }
  } catch (...) {  // a thread could not be started: the others stop, too
    stop();
    threads_.clear();
    throw;
  }
}

void WorkerPool::run(Worker& worker) {
  const HooksOfThread hooks(polled_);
  try {
    work_(worker);
  } catch (...) {
    keep(std::current_exception());
  }
  worker.since_ = 0;
  const std::lock_guard lock(mutex_);
  if (--at_work_ == 0) ended_.notify_all();
}

void WorkerPool::keep(std::exception_ptr failure) {
  stop();
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(failure);
}

bool WorkerPool::wait_for(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, time, [this] { return at_work_ == 0; });
}

void WorkerPool::rethrow() const {
  if (failure_) std::rethrow_exception(failure_);
}

// --- loops ---

namespace {

constexpr auto kBetweenReports = std::chrono::milliseconds(20);

class SharedLoop {
 public:
  SharedLoop(const Loop& loop, const Hooks& hooks, const std::function<Body()>& make_body)
      : loop_(loop), hooks_(hooks), asked_(polled(hooks)), make_body_(make_body) {}

  void run_here() {
    using Clock = std::chrono::steady_clock;
    const HooksOfThread within(asked_);
    const Body body = make_body_();
    auto reported = Clock::now();
    for (std::size_t i = 0; i < loop_.count; ++i) {
      kernel::poll();
      body(i);
      done_ = i + 1;
      if (loop_.largest_block > 1 && Clock::now() - reported < kBetweenReports) continue;
      report({});
      reported = Clock::now();
    }
    report({});
  }

  void run_in(int threads) {
    block_ = std::clamp<std::size_t>(loop_.count / (16 * static_cast<std::size_t>(threads)), 1, loop_.largest_block);
    WorkerPool pool(threads, hooks_, [this](WorkerPool::Worker& worker) { work(worker); });
    while (!pool.wait_for(kBetweenReports)) report(loop_.name ? pool.slow_step(kSlowStep) : std::nullopt);
    pool.rethrow();
    report({});
  }

 private:
  void work(WorkerPool::Worker& worker) {
    const Body body = make_body_();
    for (std::size_t first = next_.fetch_add(block_); first < loop_.count && !worker.must_stop();
         first = next_.fetch_add(block_)) {
      const std::size_t end = std::min(loop_.count, first + block_);
      for (std::size_t i = first; i < end && !worker.stopped(); ++i) {
        if (loop_.name) worker.begin(i);
        body(i);
      }
      done_ += end - first;
    }
  }

  // On the calling thread.
  void report(std::optional<std::uint64_t> slow_step) const {
    if (hooks_.progress) {
      const std::string slow = slow_step ? loop_.name(*slow_step) : std::string();
      hooks_.progress({loop_.stage, done_, loop_.count, slow});
    }
    if (asked_.cancelled && asked_.cancelled()) throw Cancelled();
  }

  const Loop& loop_;
  const Hooks& hooks_;
  const Hooks asked_;
  const std::function<Body()>& make_body_;
  std::size_t block_ = 1;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::size_t> done_{0};
};

}  // namespace

void parallel_for(const Loop& loop, const Hooks& hooks, const std::function<Body()>& make_body) {
  if (loop.count == 0) return;
  const int wanted = loop.threads > 0 ? loop.threads : usable_threads();
  const int threads = static_cast<int>(std::min(loop.count, static_cast<std::size_t>(wanted)));
  SharedLoop shared(loop, hooks, make_body);
  if (loop.count <= loop.few || (threads == 1 && !loop.name)) {
    shared.run_here();
  } else {
    shared.run_in(threads);
  }
}

void parallel_for(std::size_t count, int threads, std::string_view stage, const Hooks& hooks, const Body& body) {
  parallel_for({.count = count, .threads = threads, .stage = stage}, hooks, [&body] { return std::cref(body); });
}

}  // namespace exactff::files
