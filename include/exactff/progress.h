// What long computations tell their caller, and how the caller ends them.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace exactff {

// The progress of the work. Hooks are called with it from one thread at a time.
struct Progress {
  std::string_view stage;
  std::size_t done = 0;
  std::size_t total = 0;
};

struct Hooks {
  std::function<void(const Progress&)> progress;
  std::function<bool()> cancelled;  // called between receivers, from any thread
};

// Thrown if Hooks::cancelled returned true.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

// A part of a result that was left out, and why: for example because the scene has nothing for it.
struct LeftOut {
  std::string what;
  std::string why;
};

}  // namespace exactff
