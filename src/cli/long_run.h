// What commands that work for long have in common: a progress bar, an ear for Ctrl-C.
#pragma once

#include <chrono>
#include <csignal>
#include <string>

#include "exactff/study.h"

namespace exactff::cli {

inline constexpr int kInterrupted = 128 + SIGINT;  // exit code

// A bar with the time left, on a terminal only; at most ten times a second.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const study::Progress& progress);
  void clear() const;

 private:
  using Clock = std::chrono::steady_clock;
  static void draw(const study::Progress& progress, double elapsed);

  const bool on_terminal_;
  std::string stage_;
  Clock::time_point started_;
  Clock::time_point drawn_;
};

// While it lives, Ctrl-C sets a flag instead of ending the program; a second Ctrl-C ends it at once.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  struct sigaction before_ {};
};
[[nodiscard]] bool is_interrupted();

// One word of a command line, quoted for the shell where it must be.
[[nodiscard]] std::string shell_word(const std::string& text);

}  // namespace exactff::cli
