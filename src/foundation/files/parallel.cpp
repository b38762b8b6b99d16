#include "files/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "kernel/poll.h"

namespace exactff::files {
namespace {

class SharedLoop {
 public:
  SharedLoop(std::size_t count, std::string_view stage, const Hooks& hooks,
             const std::function<void(std::size_t)>& body)
      : count_(count), stage_(stage), hooks_(hooks), body_(body) {
    const Hooks* const callers = kernel::hooks_of_thread;
    polled_.cancelled = hooks.cancelled || callers == nullptr ? hooks.cancelled : callers->cancelled;
  }

  // The loop of one thread: takes the next index until none is left or any thread has thrown.
  void work() {
    const HooksOfThread hooks(polled_);
    try {
      for (std::size_t i = next_++; i < count_ && !stop_; i = next_++) {
        kernel::poll();
        body_(i);
        report();
      }
    } catch (...) {
      keep(std::current_exception());
    }
  }

  // Keeps the exception and ends the loops of all threads.
  void keep(std::exception_ptr failure) {
    stop_ = true;
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void report() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (hooks_.progress) hooks_.progress({stage_, done_, count_});
  }

  const std::size_t count_;
  const std::string_view stage_;
  const Hooks& hooks_;
  Hooks polled_;  // by the bodies: without progress, which is that of this loop
  const std::function<void(std::size_t)>& body_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

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

void parallel_for(std::size_t count, int threads, std::string_view stage, const Hooks& hooks,
                  const std::function<void(std::size_t)>& body) {
  SharedLoop loop(count, stage, hooks, body);
  {
    std::vector<std::jthread> helpers;
    const auto wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    try {
      for (std::size_t i = 1; i < wanted; ++i) helpers.emplace_back([&loop] { loop.work(); });
    } catch (...) {  // a thread could not be started: the others stop, too
      loop.keep(std::current_exception());
    }
    loop.work();
  }
  loop.rethrow();
}

}  // namespace exactff::files
