// Whether this process is writing something that must appear all at once.
#pragma once

#include <atomic>

namespace exactff::files {

// Lives from before the first byte is written until the result is in its place or removed.
class Unfinished {
 public:
  Unfinished() { ++count_; }
  ~Unfinished() { --count_; }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  // If true, the process should not be ended now. Safe in signal handlers.
  [[nodiscard]] static bool any() { return count_ > 0; }

 private:
  inline static std::atomic<int> count_ = 0;
  static_assert(std::atomic<int>::is_always_lock_free);
};

}  // namespace exactff::files
