// What long computations tell their caller, and how the caller ends them.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace exactff {

// The progress of the work. Hooks are called with it from the thread that called the function.
struct Progress {
  std::string_view stage;
  std::size_t done = 0;
  std::size_t total = 0;
  // What takes long just now, in the words of messages: "from 'floor' to 'light'". Of all that is being computed, the
  // step that began first, if it has taken a second; empty if there is none, or where steps have no names.
  std::string_view slow = {};
};

// `cancelled` is called from any thread, every few milliseconds, also within a single pair of receiver and source. It
// must be quick. The polygon Booleans and the building of Embree's trees do not call it; both can take seconds.
struct Hooks {
  std::function<void(const Progress&)> progress;
  std::function<bool()> cancelled;
};

// Thrown if Hooks::cancelled returned true.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

// During its lifetime, functions without a parameter for hooks use these hooks when this thread calls them:
// exact_form_factor and every method ask `cancelled`, and so do the functions that make receivers, which also report
// progress. They throw Cancelled where the answer is true; what they were writing to is then unspecified, but may be
// used again. Objects nest, and the innermost counts. Keeps a reference.
class HooksOfThread {
 public:
  explicit HooksOfThread(const Hooks& hooks);
  explicit HooksOfThread(Hooks&&) = delete;
  ~HooksOfThread();
  HooksOfThread(const HooksOfThread&) = delete;
  HooksOfThread& operator=(const HooksOfThread&) = delete;

 private:
  const Hooks* before_;
};

// A part of a result that was left out, and why: for example because the scene has nothing for it.
struct LeftOut {
  std::string what;
  std::string why;
};

}  // namespace exactff
