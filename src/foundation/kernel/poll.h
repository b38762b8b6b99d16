// Long loops ask the hooks of their thread whether to go on (exactff/jobs.h).
#pragma once

#include <cstddef>
#include <string_view>

#include "exactff/jobs.h"

namespace exactff::kernel {

inline constinit thread_local const Hooks* hooks_of_thread = nullptr;  // set by HooksOfThread

void ask_hooks();  // requires hooks

// Throws Cancelled if the hooks request it. To be called every few milliseconds, since the hooks may be slow.
inline void poll() {
  if (hooks_of_thread != nullptr) ask_hooks();
}

// The same once in a while, for a loop of many short steps, which also reports its progress.
class Steps {
 public:
  Steps(std::string_view stage, std::size_t total) : stage_(stage), total_(total) {}

  void take() {
    constexpr std::size_t kEvery = 256;
    if (++taken_ % kEvery == 0 && hooks_of_thread != nullptr) tell();
  }

 private:
  void tell() const;

  std::string_view stage_;
  std::size_t total_;
  std::size_t taken_ = 0;
};

}  // namespace exactff::kernel
