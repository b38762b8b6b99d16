// The program as a process: its exit code, Ctrl-C and a progress bar, and other processes that it was started with.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "exactff/jobs.h"
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
  // Show the progress of work here, and cancel it after a signal.
  [[nodiscard]] Hooks hooks();

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
// this function prints `words` and returns the exit code of the signal.
[[nodiscard]] int unless_interrupted(const std::function<int()>& command,
                                     const std::string& words = "exactff: interrupted\n");

// Calls `prepare`, shows the progress of what it makes (exactff/jobs.h), and throws Cancelled after a signal.
template <class Prepare>
auto with_progress(const Prepare& prepare) {
  ProgressBar bar;
  const Hooks hooks = bar.hooks();
  const HooksOfThread shown(hooks);
  auto prepared = prepare();
  leave_if_interrupted();
  return prepared;
}

// --- Kept work ---

// Shared by the commands whose work is kept in a journal: what they print meanwhile, and their processes under mpirun.

// "2/4"; one shard if the text is empty. Throws InputError.
[[nodiscard]] jobs::Shard shard_of(const std::string& text);

// --resume and --force, of the arguments of a command.
struct KeptRun {
  bool resume = false, force = false;

  void add_to(CLI::App& app, const std::string& what_force_does,
              const std::string& what_resume_does = "Continue an interrupted run, if there is one") {
    CLI::Option* option = app.add_flag("--resume", resume, what_resume_does);
    app.add_flag("--force", force, what_force_does)->excludes(option);
  }
  [[nodiscard]] jobs::Existing existing() const {
    return resume ? jobs::Existing::kResume : force ? jobs::Existing::kReplace : jobs::Existing::kRefuse;
  }
};

constexpr double kNeverSlow = std::numeric_limits<double>::infinity();  // seconds: where long rows are usual

// Prints progress and messages while rows are computed.
class Narrator {
 public:
  // What a row is called: "row", "pair".
  explicit Narrator(std::string row) : row_(std::move(row)), rows_(row_ + 's') {}

  [[nodiscard]] jobs::RowHooks hooks(double slow_seconds);
  void clear() const { bar_.clear(); }
  // Calls work(). False if it was interrupted. If it is given up, for that or by an exception, which is passed on,
  // tells what is kept of `file`.
  [[nodiscard]] bool is_done(const std::string& file, const std::function<void()>& work) const;

 private:
  void tell_what_is_kept(const std::string& reason, const std::string& file) const;
  void show(const Progress& progress);
  void tell(const std::string& text);
  void tell_slow(const std::string& row, double seconds);

  const std::string row_, rows_;
  ProgressBar bar_;
  Progress progress_;
  int slow_ = 0;
};

// What ends a run that was given up: the words before it ends, and the exit code of the signal.
[[nodiscard]] std::string words_of_interruption(const std::string& row, const std::string& file);
[[nodiscard]] int exit_code_of_interruption();

// What the processes of a command do, each of which parsed the same flags.
struct TeamWork {
  std::string row;                              // as for Narrator
  std::function<void()> refuse;                 // throws InputError for flags that a team cannot serve
  std::function<int(jobs::Team* team)> write;   // alone (null) or as the leader; returns the exit code
  std::function<int(jobs::Team& team)> follow;  // as another rank
};
// Finds out whether this process was started with others, and runs it as what it is. Returns the exit code.
[[nodiscard]] int run_alone_or_in_team(const TeamWork& work);

}  // namespace exactff::cli
