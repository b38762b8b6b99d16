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
  throw InputError(
      {.what = "several processes were started together, but MPI is not available: " + std::move(why_not),
       .why = "each process would do all the work",
       .suggestion =
           "start only one process, use --shard, or build exactff with libboost-mpi-dev and libopenmpi-dev installed"});
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

int unless_interrupted(const std::function<int()>& command) {
  const std::string said = "exactff: interrupted\n";
  const InterruptWatch watch(said);
  const Hooks hooks{{}, is_interrupted};
  const HooksOfThread stopped(hooks);
  try {
    return command();
  } catch (const Cancelled&) {
    std::cerr << said;
    return 128 + interrupting_signal();
  }
}

}  // namespace exactff::cli
