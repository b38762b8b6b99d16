#include "batch/crew.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "files/parallel.h"
#include "kernel/poll.h"

namespace exactff::batch {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kBetweenLooks = std::chrono::milliseconds(20);
constexpr std::size_t kLargestBlock = 64;

class Crew {
 public:
  Crew(std::size_t count, const char* stage, const Hooks& hooks, const std::function<Body()>& make_body)
      : count_(count), stage_(stage), hooks_(hooks), make_body_(make_body) {
    const Hooks* const callers = kernel::hooks_of_thread;
    polled_.cancelled = hooks.cancelled || callers == nullptr ? hooks.cancelled : callers->cancelled;
  }

  void run_here() {
    const HooksOfThread hooks(polled_);
    const Body body = make_body_();
    auto looked = Clock::now();
    for (std::size_t i = 0; i < count_; ++i) {
      body(i);
      done_ = i + 1;
      if (Clock::now() - looked < kBetweenLooks) continue;
      look();
      looked = Clock::now();
    }
    look();
  }

  void run_in(std::size_t threads) {
    block_ = std::clamp<std::size_t>(count_ / (16 * threads), 1, kLargestBlock);
    {
      std::vector<std::jthread> members;
      try {
        for (std::size_t i = 0; i < threads; ++i) start(members);
        while (!wait()) look();
      } catch (...) {  // a thread could not be started, or the hooks have ended the work: the others stop, too
        keep(std::current_exception());
      }
    }
    if (failure_) std::rethrow_exception(failure_);
    look();
  }

 private:
  void start(std::vector<std::jthread>& members) {
    {
      const std::lock_guard lock(mutex_);
      ++at_work_;
    }
    try {
      members.emplace_back([this] { work(); });
    } catch (...) {
      leave();
      throw;
    }
  }

  void work() {
    const HooksOfThread hooks(polled_);
    try {
      const Body body = make_body_();
      for (std::size_t first = next_.fetch_add(block_); first < count_ && !stop_; first = next_.fetch_add(block_)) {
        kernel::poll();
        const std::size_t end = std::min(count_, first + block_);
        for (std::size_t i = first; i < end && !stop_; ++i) body(i);
        done_ += end - first;
      }
    } catch (...) {
      keep(std::current_exception());
    }
    leave();
  }

  void leave() {
    const std::lock_guard lock(mutex_);
    if (--at_work_ == 0) ended_.notify_all();
  }

  void keep(std::exception_ptr failure) {
    stop_ = true;
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }

  [[nodiscard]] bool wait() {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, kBetweenLooks, [this] { return at_work_ == 0; });
  }

  // On the calling thread.
  void look() {
    if (hooks_.progress) hooks_.progress({stage_, std::min<std::size_t>(done_, count_), count_});
    if (polled_.cancelled && polled_.cancelled()) throw Cancelled();
  }

  const std::size_t count_;
  const char* const stage_;
  const Hooks& hooks_;
  const std::function<Body()>& make_body_;
  Hooks polled_;  // by the bodies: without progress, which is that of this loop
  std::size_t block_ = 1;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t at_work_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

void share(std::size_t count, std::size_t few, const char* stage, const Run& run,
           const std::function<Body()>& make_body) {
  if (count == 0) return;
  const int wanted = run.threads > 0 ? run.threads : files::usable_threads();
  const std::size_t threads = std::min(count, static_cast<std::size_t>(wanted));
  Crew crew(count, stage, run.hooks, make_body);
  if (threads == 1 || count <= few) {
    crew.run_here();
  } else {
    crew.run_in(threads);
  }
}

}  // namespace exactff::batch
