#include "fuzz/program_trial.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "files/parallel.h"
#include "support/program.h"
#include "unit/outside/sanitized.h"

namespace exactff::validation {

namespace fs = std::filesystem;

namespace {

constexpr int kProcessorSeconds = kSanitized ? 240 : 60;  // 14,000 polygon Booleans take half a minute
constexpr int kWallSeconds = 10 * kProcessorSeconds;      // other processes need time, too
constexpr rlim_t kMegabytes = 3000;
// Of processor time, from a signal to the end: wall time depends on the load. Each processor may use this much.
constexpr double kPatience = kSanitized ? 5.0 : 0.5;
constexpr int kNeverStarted = 127;  // the dynamic loader found no memory

struct Ended {
  int code = 0;  // 128 + signal if a signal ended it
  bool by_signal = false;
  bool hung = false;
  bool signalled = false;  // a signal was sent
  double seconds_after_signal = 0.0;
};

void limit(__rlimit_resource resource, rlim_t value) {
  const rlimit both{value, value};
  ::setrlimit(resource, &both);
}

void redirect(const char* path, int descriptor) {
  const int file = ::open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(file, descriptor);
  ::close(file);
}

[[noreturn]] void be_the_program(const std::string& program, const Words& words, const fs::path& folder,
                                 const std::function<void()>& limits, bool full_output) {
  std::vector<std::string> copies = words;
  copies.insert(copies.begin(), program);
  std::vector<char*> pointers;
  for (std::string& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  if (::chdir(folder.c_str()) != 0) ::_exit(126);
  redirect("/dev/null", STDIN_FILENO);
  redirect(full_output ? "/dev/full" : "stdout", STDOUT_FILENO);
  redirect("stderr", STDERR_FILENO);
  ::setenv("TMPDIR", folder.c_str(), 1);
  for (const char* options : {"ASAN_OPTIONS", "UBSAN_OPTIONS"})
    ::setenv(options, "exitcode=86", 1);  // not one of our exit codes
  limit(RLIMIT_CPU, kProcessorSeconds);
  limit(RLIMIT_CORE, 0);
  if (!kSanitized) limit(RLIMIT_AS, kMegabytes << 20);
  limits();
  ::execv(pointers[0], pointers.data());
  ::_exit(126);
}

bool ends_within(int pidfd, int milliseconds) {
  pollfd one{pidfd, POLLIN, 0};
  return ::poll(&one, 1, milliseconds) > 0;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// Of a running process: fields 14 and 15 of its stat file, after its name in parentheses.
double processor_seconds(pid_t process) {
  const std::string stat = text_of("/proc/" + std::to_string(process) + "/stat");
  std::istringstream fields(stat.substr(std::min(stat.rfind(')') + 2, stat.size())));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

Ended wait_for(pid_t process, const ProgramCase* disturbed) {
  Ended ended;
  double before = 0.0;
  const auto pidfd = static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
  if (disturbed != nullptr && disturbed->disturbance == Disturbance::kSignal &&
      !ends_within(pidfd, disturbed->amount)) {
    before = processor_seconds(process);
    ended.signalled = ::kill(process, disturbed->signal) == 0;
  }
  if (!ends_within(pidfd, kWallSeconds * 1000)) {
    ended.hung = true;
    ::kill(process, SIGKILL);
  }
  ::close(pidfd);
  int status = 0;
  rusage used{};
  ::wait4(process, &status, 0, &used);
  ended.by_signal = WIFSIGNALED(status);
  ended.code = ended.by_signal ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  ended.hung = ended.hung || ended.code == 128 + SIGXCPU || (ended.code == 128 + SIGKILL && !ended.signalled);
  ended.seconds_after_signal = ended.signalled ? seconds(used.ru_utime) + seconds(used.ru_stime) - before : 0.0;
  return ended;
}

// `disturbed`: the case whose disturbance applies to this command, or null.
Ended run(const std::string& program, const Words& words, const fs::path& folder, const ProgramCase* disturbed) {
  const bool full_output = disturbed != nullptr && disturbed->disturbance == Disturbance::kFullOutput;
  const auto limits = [&] {
    if (disturbed == nullptr) return;
    const auto amount = static_cast<rlim_t>(disturbed->amount);
    if (disturbed->disturbance == Disturbance::kLittleMemory && !kSanitized) limit(RLIMIT_AS, amount << 20);
    if (disturbed->disturbance == Disturbance::kFullDisk) limit(RLIMIT_FSIZE, amount);
  };
  for (const char* stream : {"stdout", "stderr"}) std::ofstream(folder / stream);  // it may end before it starts
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("cannot start a process");
  if (process == 0) be_the_program(program, words, folder, limits, full_output);
  return wait_for(process, disturbed);
}

bool given(const Words& words, const std::string& word) { return std::ranges::find(words, word) != words.end(); }

// With check, --json has a file.
std::string form_of(const Words& words, const ProgramCase* disturbed) {
  if (disturbed != nullptr && disturbed->disturbance == Disturbance::kFullOutput) return "cut";
  if (words.empty() || given(words, "--help") || given(words, "--version")) return "text";
  const bool has_form = words.front() == "info" || words.front() == "view" || words.front() == "radiosity";
  if (has_form && given(words, "--json")) return "json";
  if (words.front() != "point") return "text";
  return given(words, "--plain") ? "plain" : given(words, "--json") ? "json" : "text";
}

std::string wrong_ending(const Ended& ended, const Words& words, const ProgramCase* disturbed) {
  const auto suffers = [&](Disturbance one) { return disturbed != nullptr && disturbed->disturbance == one; };
  if (ended.hung) return "does not end";
  if (ended.signalled) {
    const bool told = ended.code == 128 + disturbed->signal;
    if (told && ended.seconds_after_signal > kPatience * files::usable_threads()) return "works on after a signal";
    if (told) return {};
  }
  if (ended.by_signal) return std::string("ended by ") + ::strsignal(ended.code - 128);
  if (ended.code == 0 || ended.code == 2) return {};
  const std::string command = words.empty() ? "" : words.front();
  if (ended.code == 1 && command == "check") return {};
  static const Words kMayFallShort = {"point", "view", "matrix", "radiosity", "truth", "merge"};
  if (ended.code == 3 && given(kMayFallShort, command)) return {};
  if (suffers(Disturbance::kLittleMemory) && (ended.code == 4 || ended.code == kNeverStarted)) return {};
  return "exit code " + std::to_string(ended.code);
}

void write_files(const Files& files, const fs::path& folder) {
  fs::create_directories(folder / "in");
  fs::create_directories(folder / "out");
  for (const auto& [path, text] : files) std::ofstream(folder / path, std::ios::binary) << text;
}

// --- the same bytes ---

// In the folder of a study, only files without times are promised to be equal (exactff/study.h). A strip of pictures
// shows times, too.
bool is_promised(const fs::path& file, const Words& words) {
  if (words.front() == "render") return file.extension() != ".png" || !given(words, "--strip");
  if (words.front() != "compare" && words.front() != "stress") return true;
  return words.front() == "compare" && file.extension() == ".csv" &&
         std::ranges::any_of(std::array{"values", "exact", "summary"}, [&](const std::string& name) {
           return file.stem() == name || file.stem().string().ends_with("_" + name);
         });
}

std::map<std::string, std::string> promised_files(const fs::path& folder, const Words& words) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out")) {
    if (entry.is_regular_file() && is_promised(entry.path(), words)) {
      files[fs::relative(entry.path(), folder)] = text_of(entry.path());
    }
  }
  return files;
}

std::string difference(const fs::path& one, const fs::path& other, const Words& words) {
  const auto first = promised_files(one, words), second = promised_files(other, words);
  for (const auto& [name, text] : first) {
    const auto same = second.find(name);
    if (same == second.end()) return name + " is not there the second time";
    if (same->second != text) return name + " has other bytes the second time";
  }
  if (first.size() != second.size()) return "other files the second time";
  const bool prints_times = std::ranges::any_of(std::array{"compare", "truth", "merge", "stress", "render"},
                                                [&](const std::string& command) { return words.front() == command; });
  return !prints_times && text_of(one / "stdout") != text_of(other / "stdout") ? "stdout differs the second time" : "";
}

Words with_threads(Words words, int threads) {
  const auto flag = std::ranges::find(words, "--threads");
  if (flag != words.end() && flag + 1 != words.end() && *(flag + 1) != "") *(flag + 1) = std::to_string(threads);
  return words;
}

// --- a case ---

class Trial {
 public:
  Trial(const ProgramCase& one, const Bench& bench, OutputJudge& judge) : case_(one), bench_(bench), judge_(judge) {}

  std::string problem() {
    std::error_code ignored;
    fs::remove_all(bench_.scratch, ignored);
    const Words& last = case_.commands.back();
    std::string wrong = run_all(case_.commands, bench_.scratch / "first", &case_);
    if (!wrong.empty() || last.empty()) return wrong;
    if (case_.disturbance == Disturbance::kTwice) return ended_.code == 2 ? "" : run_twice();
    return case_.disturbance == Disturbance::kSignal && ended_.signalled ? resume() : "";
  }

 private:
  std::string run_all(const std::vector<Words>& commands, const fs::path& folder, const ProgramCase* disturbed) {
    write_files(case_.files, folder);
    for (std::size_t i = 0; i < commands.size(); ++i) {
      std::string wrong = run_one(commands[i], folder, i + 1 == commands.size() ? disturbed : nullptr);
      if (!wrong.empty()) return wrong;
    }
    return {};
  }

  std::string run_one(const Words& words, const fs::path& folder, const ProgramCase* disturbed) {
    ended_ = run(bench_.program, words, folder, disturbed);
    std::string wrong = wrong_ending(ended_, words, disturbed);
    // A killed process cannot clean up.
    const bool killed = ended_.signalled && ended_.code == 128 + SIGKILL;
    if (wrong.empty() && !killed) wrong = judge_.judge(folder, form_of(words, disturbed), ended_.code);
    return wrong.empty() ? "" : (words.empty() ? "" : words.front()) + ": " + wrong;
  }

  // Runs without the disturbance in another folder, and compares.
  std::string compare_with(const std::vector<Words>& commands) {
    const int code = ended_.code;
    std::string wrong = run_all(commands, bench_.scratch / "second", nullptr);
    const Words& last = case_.commands.back();
    if (wrong.empty() && ended_.code != code) wrong = last.front() + ": another exit code the second time";
    if (!wrong.empty()) return wrong;
    const std::string different = difference(bench_.scratch / "first", bench_.scratch / "second", last);
    return different.empty() ? "" : last.front() + ": " + different;
  }

  std::string run_twice() {
    std::vector<Words> again = case_.commands;
    again.back() = with_threads(again.back(), case_.amount);
    return compare_with(again);
  }

  // An interrupted run, when resumed, gives the bytes of an undisturbed run.
  std::string resume() {
    const Words& last = case_.commands.back();
    const bool can = (last.front() == "truth" || last.front() == "compare" || last.front() == "render") &&
                     !given(last, "--resume") && !given(last, "--force");
    if (!can || ended_.code != 128 + case_.signal) return {};
    Words resumed = last;
    resumed.insert(resumed.begin() + 1,
                   "--resume");  // at the end of the line it could be read as the value of an option
    std::string wrong = run_one(resumed, bench_.scratch / "first", nullptr);
    return wrong.empty() ? compare_with(case_.commands) : "resumed " + wrong;
  }

  const ProgramCase& case_;
  const Bench& bench_;
  OutputJudge& judge_;
  Ended ended_;
};

}  // namespace

OutputJudge::OutputJudge() {
  std::array<int, 2> to{}, from{};
  if (::pipe2(to.data(), O_CLOEXEC) != 0 || ::pipe2(from.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  process_ = ::fork();
  if (process_ == 0) {
    ::dup2(to[0], STDIN_FILENO);
    ::dup2(from[1], STDOUT_FILENO);
    ::execlp("python3", "python3", "-B", EXACTFF_OUTPUT_JUDGE, nullptr);
    ::_exit(126);
  }
  ::close(to[0]);
  ::close(from[1]);
  questions_ = ::fdopen(to[1], "w");
  answers_ = ::fdopen(from[0], "r");
}

OutputJudge::~OutputJudge() {
  std::fclose(questions_);
  std::fclose(answers_);
  ::waitpid(process_, nullptr, 0);
}

std::string OutputJudge::judge(const fs::path& folder, const std::string& form, int exit_code) {
  std::fprintf(questions_, "%s\t%s\t%d\n", folder.c_str(), form.c_str(), exit_code);
  std::fflush(questions_);
  std::array<char, 4096> line{};
  if (std::fgets(line.data(), line.size(), answers_) == nullptr)
    throw std::runtime_error("the judge of outputs has died");
  std::string answer = line.data();
  while (!answer.empty() && answer.back() == '\n') answer.pop_back();
  return answer;
}

std::string problem_of(const ProgramCase& one, const Bench& bench, OutputJudge& judge) {
  return Trial(one, bench, judge).problem();
}

int least_megabytes(const Bench& bench) {
  fs::create_directories(bench.scratch);
  ProgramCase start{.files = {}, .commands = {{"--version"}}, .disturbance = Disturbance::kLittleMemory};
  for (start.amount = 20; start.amount < 1000; start.amount += 4) {
    if (run(bench.program, start.commands.front(), bench.scratch, &start).code == 0) break;
  }
  return start.amount;
}

}  // namespace exactff::validation
