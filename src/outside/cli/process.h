// The program as a process: its exit code, Ctrl-C and a progress bar, and other processes that it was started with.
#pragma once

#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <string>

#include "exactff/progress.h"
#include "jobs/team.h"

namespace exactff::cli {

inline constexpr int kBadInput = 2;
inline constexpr int kNotAsAsked = 3;  // a value is not as accurate or certified as asked
inline constexpr int kInternalFailure = 4;

// The return value of the command. If it throws, prints why and returns 2 or 4.
[[nodiscard]] int exit_code_of(const std::function<int()>& command);

// --- the processes that one mpirun or srun started together ---

// The rank of this process, read from the environment that the launcher sets; 0 if it was started alone.
[[nodiscard]] int launched_rank();

// Returns null if this process was started alone; the program then neither needs MPI nor waits until it is loaded.
// Throws InputError if several processes were started and MPI is not available: each would do all the work. Call it
// once, before the first thread is started.
[[nodiscard]] std::unique_ptr<jobs::Team> join_team();

// --- long runs ---

// A bar with the remaining time and the rate. Drawn on a terminal only, at most ten times a second. Work that was
// already done when a stage is first shown, such as the resumed part of a run, counts for neither.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const Progress& progress);
  void clear() const;

 private:
  using Clock = std::chrono::steady_clock;
  void draw(const Progress& progress, double elapsed) const;

  const bool on_terminal_;
  std::string stage_;
  std::size_t done_before_ = 0;
  Clock::time_point started_;
  Clock::time_point drawn_;
};

// During its lifetime, Ctrl-C (SIGINT), SIGTERM and SIGHUP set a flag instead of ending the program. A second signal
// ends it at once, unless files are being written; the program soon gives that up. Objects nest, and the innermost
// counts.
class InterruptWatch {
 public:
  InterruptWatch();
  // The work checks the flag every few milliseconds, but not everywhere: not while it reads a scene, or in the polygon
  // Booleans. If the work has not ended 0.4 s after the signal, the program prints `last_words` and ends with the exit
  // code of the signal. Use this only for work that survives being killed.
  explicit InterruptWatch(const std::string& last_words);
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
  struct sigaction alarm_before_ {};
  bool made_timer_ = false;
  bool patience_ended_before_;
  std::string words_before_;
};
[[nodiscard]] bool is_interrupted();
[[nodiscard]] int interrupting_signal();  // 0 if none came
void leave_if_interrupted();              // throws Cancelled

// Runs a command under a watch. After a signal its computations throw Cancelled; if the command does not catch that,
// this function says so and returns the exit code of the signal.
[[nodiscard]] int unless_interrupted(const std::function<int()>& command);

// Calls `prepare`, shows the progress of what it makes (exactff/progress.h), and throws Cancelled after a signal.
template <class Prepare>
auto with_progress(const Prepare& prepare) {
  ProgressBar bar;
  const Hooks hooks{[&](const Progress& progress) { bar.show(progress); }, is_interrupted};
  const HooksOfThread shown(hooks);
  auto prepared = prepare();
  leave_if_interrupted();
  return prepared;
}

}  // namespace exactff::cli
