#include "cli/process.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "exactff/error.h"
#include "files/file.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {

int exit_code_of(const std::function<int()>& command) {
  constexpr const char* kOutOfMemory =
      "exactff: out of memory (the scene and the request need more than is available); nothing was written; use a "
      "smaller scene or grid or fewer --threads, or raise the limit\n";
  try {
    return command();
  } catch (const InputError& error) {
    std::cerr << "exactff: " << error.what() << '\n';
    return kBadInput;
  } catch (const std::bad_alloc&) {
    std::cerr << kOutOfMemory;
  } catch (const std::length_error&) {  // more than any memory could hold
    std::cerr << kOutOfMemory;
  } catch (const std::system_error& error) {
    std::cerr << "exactff: the operating system refused a request: " << text::printable(error.what())
              << " (a thread could not be started or a file could not be opened); nothing was written; try --threads "
                 "1, or raise the limits\n";
  } catch (const std::exception& error) {
    std::cerr << "exactff: internal failure: " << text::printable(error.what())
              << " (this is a bug in exactff); please report it with the scene and the command line\n";
  }
  return kInternalFailure;
}

// --- the processes that one mpirun or srun started together ---

namespace {

namespace fs = std::filesystem;

// The variables that launchers set: Open MPI's mpirun; the MPICH family and srun --mpi=pmi2; srun --mpi=pmix.
constexpr std::array kRanks = {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"};
constexpr std::array kSizes = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};

template <class Names>
std::optional<int> number_in_environment(const Names& names) {
  for (const char* name : names) {
    const char* text = std::getenv(name);
    int number = 0;
    if (text != nullptr && std::from_chars(text, text + std::strlen(text), number).ec == std::errc{}) return number;
  }
  return std::nullopt;
}

bool launched_with_others() {
  const std::optional<int> size = number_in_environment(kSizes);
  return size ? *size > 1 : number_in_environment(kRanks).has_value();
}

[[noreturn]] void refuse(std::string why_not) {
  text::refuse(
      "several processes were started together, but MPI is not available: " + std::move(why_not),
      "each process would do all the work",
      "start only one process, use --shard, or build exactff with libboost-mpi-dev and libopenmpi-dev installed");
}

// The module is beside the program in the build folder, or where it is installed.
fs::path module_path() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {"exactff_mpi.so", EXACTFF_INSTALLED_MPI}) {
    if (fs::exists(folder / place, error)) return folder / place;
  }
  refuse("this program was built without it");
}

}  // namespace

int launched_rank() { return number_in_environment(kRanks).value_or(0); }

std::unique_ptr<jobs::Team> join_team() {
  if (!launched_with_others()) return nullptr;
  // RTLD_GLOBAL: Open MPI loads its own components, which need its symbols. The module is never closed.
  void* module = ::dlopen(module_path().c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) refuse(::dlerror());
  using Join = jobs::Team*();
  auto* const join = reinterpret_cast<Join*>(::dlsym(module, "exactff_join_mpi"));
  if (join == nullptr) refuse(::dlerror());
  std::unique_ptr<jobs::Team> team(join());
  return team->size() > 1 ? std::move(team) : nullptr;
}

// --- long runs ---

ProgressBar::ProgressBar() : on_terminal_(::isatty(STDERR_FILENO) == 1) {}
ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::show(const Progress& progress) {
  if (!on_terminal_) return;
  const auto now = Clock::now();
  if (progress.stage != stage_) {
    stage_ = progress.stage;
    started_ = now;
    done_before_ = progress.done;
  }
  if (now - drawn_ < std::chrono::milliseconds(100) && progress.done < progress.total) return;
  drawn_ = now;
  draw(progress, std::chrono::duration<double>(now - started_).count());
}

Hooks ProgressBar::hooks() {
  return {[this](const Progress& progress) { show(progress); }, is_interrupted};
}

void ProgressBar::clear() const {
  if (on_terminal_ && drawn_ != Clock::time_point{}) std::cerr << "\r\033[K" << std::flush;
}

void ProgressBar::draw(const Progress& progress, double elapsed) const {
  constexpr std::size_t kWidth = 30;
  const std::size_t filled = kWidth * progress.done / std::max<std::size_t>(progress.total, 1);
  std::cerr << "\r\033[K" << text::printable(progress.stage) << " [" << std::string(filled, '#')
            << std::string(kWidth - filled, '.') << "] " << progress.done << '/' << progress.total;
  if (progress.done > done_before_ && elapsed > 0.0) {
    const double pace = static_cast<double>(progress.done - done_before_) / elapsed;
    std::cerr << ", " << text::duration(static_cast<double>(progress.total - progress.done) / pace) << " left, "
              << text::rounded(pace) << "/s";
  }
  std::cerr << std::flush;
}

namespace {

std::atomic<int> interrupted_by = 0;
static_assert(std::atomic<int>::is_always_lock_free);  // a signal handler uses it

// The data for signal handlers: plain, and set before the handlers are installed.
struct Patience {
  bool ends = false;
  std::array<char, 4096> last_words{};
};
Patience patience;
timer_t timer{};
bool has_timer = false;

void wait_for(long milliseconds) {
  itimerspec time{};
  time.it_value.tv_nsec = milliseconds * 1'000'000;
  ::timer_settime(timer, 0, &time, nullptr);
}

constexpr long kPatience = 400;

void take_note(int signal) {
  const bool again = interrupted_by.exchange(signal) != 0;
  if (!again && patience.ends) wait_for(kPatience);
  if (!again || files::Unfinished::any()) return;
  std::signal(signal, SIG_DFL);
  ::raise(signal);  // takes effect when this handler returns
}

void lose_patience(int /*signal*/) {
  constexpr long kMoment = 20;
  if (!patience.ends || files::Unfinished::any()) return wait_for(kMoment);
  const char* words = patience.last_words.data();
  static_cast<void>(!::write(STDERR_FILENO, words, std::strlen(words)));
  ::_exit(128 + interrupted_by);
}

bool make_timer() {
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  return has_timer = ::timer_create(CLOCK_MONOTONIC, &event, &timer) == 0;
}

void set_last_words(const std::string& words) {
  const std::size_t size = words.copy(patience.last_words.data(), patience.last_words.size() - 1);
  patience.last_words[size] = '\0';
}

}  // namespace

InterruptWatch::InterruptWatch(const std::string& last_words) : InterruptWatch() {
  const std::string clear_line = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
  set_last_words(clear_line + last_words);
  struct sigaction action {};
  action.sa_handler = lose_patience;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGALRM, &action, &alarm_before_);
  if (!has_timer) made_timer_ = make_timer();
  patience.ends = has_timer;
}

InterruptWatch::InterruptWatch()
    : patience_ended_before_(std::exchange(patience.ends, false)), words_before_(patience.last_words.data()) {
  struct sigaction action {};
  action.sa_handler = take_note;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &before_[i]);
    // Signals that the caller has set to be ignored (nohup) stay ignored.
    if (before_[i].sa_handler != SIG_IGN) ::sigaction(kSignals[i], &action, nullptr);
  }
}

InterruptWatch::~InterruptWatch() {
  patience.ends = false;
  set_last_words(words_before_);
  if (made_timer_) {
    ::timer_delete(timer);
    has_timer = false;
    ::sigaction(SIGALRM, &alarm_before_, nullptr);
  }
  patience.ends = patience_ended_before_;
  if (patience.ends && is_interrupted()) wait_for(kPatience);
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

bool is_interrupted() { return interrupted_by != 0; }
int interrupting_signal() { return interrupted_by; }

void leave_if_interrupted() {
  if (is_interrupted()) throw Cancelled();
}

int unless_interrupted(const std::function<int()>& command, const std::string& words) {
  const InterruptWatch watch(words);
  const Hooks hooks{{}, is_interrupted};
  const HooksOfThread stopped(hooks);
  try {
    return command();
  } catch (const Cancelled&) {
    std::cerr << words;
    return 128 + interrupting_signal();
  }
}

// --- Kept work ---

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
