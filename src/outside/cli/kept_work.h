// Shared by the commands whose work is kept in a journal: what they print meanwhile, and their processes under mpirun.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "cli/process.h"
#include "exactff/jobs.h"
#include "jobs/team.h"

namespace exactff::cli {

// "2/4"; one shard if the text is empty. Throws InputError.
[[nodiscard]] jobs::Shard shard_of(const std::string& text);

// Of --resume and --force.
[[nodiscard]] inline jobs::Existing existing_of(bool resume, bool force) {
  return resume ? jobs::Existing::kResume : force ? jobs::Existing::kReplace : jobs::Existing::kRefuse;
}

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
