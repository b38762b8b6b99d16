#include "cli/kept_work.h"

#include <charconv>
#include <csignal>
#include <iostream>
#include <memory>
#include <utility>

#include "cli/process.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {

jobs::Shard shard_of(const std::string& text) {
  jobs::Shard shard;
  if (text.empty()) return shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  if (number.ec == std::errc{} && number.ptr != end && *number.ptr == '/') {
    const auto count = std::from_chars(number.ptr + 1, end, shard.count);
    if (count.ec == std::errc{} && count.ptr == end && shard.number >= 1 && shard.number <= shard.count) return shard;
  }
  text::refuse("--shard: " + text::in_quotes(text) + " is not a shard",
               "a shard is a part of the work, numbered from 1",
               "write number/count, for example --shard 1/4 to --shard 4/4");
}

jobs::RowHooks Narrator::hooks(double slow_seconds) {
  return {.progress = [this](const Progress& progress) { show(progress); },
          .cancelled = is_interrupted,
          .note = [this](const std::string& text) { tell("warning: " + text::printable(text)); },
          .slow_row = [this](const std::string& row, double seconds) { tell_slow(row, seconds); },
          .slow_seconds = slow_seconds};
}

bool Narrator::is_done(const std::string& file, const std::function<void()>& work) const {
  try {
    work();
    return true;
  } catch (const Cancelled&) {
    tell_what_is_kept("interrupted", file);
    return false;
  } catch (...) {
    tell_what_is_kept("stopped by the error below", file);
    throw;
  }
}

void Narrator::tell_what_is_kept(const std::string& reason, const std::string& file) const {
  bar_.clear();
  if (progress_.total == 0 && !is_interrupted()) return;  // it had not begun
  std::cerr << "exactff: " << reason << "; ";
  if (progress_.total == 0) {
    std::cerr << "no " << row_ << " was begun\n";
  } else if (progress_.done == 0) {
    std::cerr << "no " << row_ << " was finished; nothing was written\n";
  } else {
    std::cerr << progress_.done << " of " << text::counted(progress_.total, row_) << " are kept in "
              << text::printable(jobs::journal_of(file).string())
              << "; to continue, run the same command with --resume\n";
  }
}

void Narrator::show(const Progress& progress) {
  if (progress.stage == rows_) progress_ = progress;
  bar_.show(progress);
}

void Narrator::tell(const std::string& text) {
  bar_.clear();
  std::cerr << text << '\n';
}

void Narrator::tell_slow(const std::string& row, double seconds) {
  constexpr int kMostTold = 50;
  if (++slow_ > kMostTold) return;
  tell("slow: " + text::printable(row) + " took " + text::duration(seconds));
  if (slow_ == kMostTold) tell("slow: further slow " + rows_ + " are counted, but not listed");
}

std::string words_of_interruption(const std::string& row, const std::string& file) {
  return "exactff: interrupted; all finished " + row + "s are kept in " +
         text::printable(jobs::journal_of(file).string()) + "; to continue, run the same command with --resume\n";
}

int exit_code_of_interruption() {
  return 128 + (interrupting_signal() != 0 ? interrupting_signal() : SIGTERM);  // another rank was interrupted
}

namespace {

// Errors are printed before the followers are dismissed: mpirun may then end this process, too.
int lead(const TeamWork& work, jobs::Team& team) {
  const int exit_code = exit_code_of([&] { return work.write(&team); });
  jobs::dismiss(team, exit_code);
  return exit_code;
}

// Everything has been reported. While a process waits here for the others to finish, mpirun may end it because another
// exit code is not 0; that is not an interruption to report.
void leave(std::unique_ptr<jobs::Team> team) {
  const InterruptWatch silent("");
  team.reset();
}

// Prints nothing, not even when it is interrupted: the leader reports all errors.
int follow(const TeamWork& work, jobs::Team& team) {
  std::cerr.rdbuf(nullptr);
  const InterruptWatch silent("");
  return work.follow(team);
}

}  // namespace

int run_alone_or_in_team(const TeamWork& work) {
  std::unique_ptr<jobs::Team> team;
  try {
    team = join_team();
    if (team != nullptr) work.refuse();
  } catch (const InputError&) {
    if (launched_rank() == 0) throw;
    leave(std::move(team));
    return 0;  // rank 0 reports it
  }
  const InterruptWatch watch("exactff: interrupted; no " + work.row + " was begun\n");
  if (team == nullptr) return work.write(nullptr);
  const int exit_code = team->rank() == 0 ? lead(work, *team) : follow(work, *team);
  leave(std::move(team));
  return exit_code;
}

}  // namespace exactff::cli
