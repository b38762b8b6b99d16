#include "fuzz/apart.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <system_error>

namespace exactff::validation {

namespace {

// By default, sanitizers end a process with exit code 1.
constexpr int kFineCode = 90;
constexpr int kProblemCode = 91;

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(file, text.data() + done, text.size() - done);
    if (count <= 0) return;
    done += static_cast<std::size_t>(count);
  }
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = read(file, buffer.data(), buffer.size());
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

// An exception must not leave this function, because the frames of the caller belong to the parent process.
[[noreturn]] void be_the_child(const std::function<std::string()>& check, unsigned seconds, int result) noexcept {
  for (const int number : {SIGALRM, SIGABRT, SIGSEGV, SIGFPE}) std::signal(number, SIG_DFL);
  alarm(seconds);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const std::string problem = check();
  write_all(result, problem);
  _exit(problem.empty() ? kFineCode : kProblemCode);
}

Ending ending_of(int status) {
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGALRM ? Ending::kHang : Ending::kCrash;
  const int code = WEXITSTATUS(status);
  return code == kFineCode ? Ending::kFine : code == kProblemCode ? Ending::kProblem : Ending::kCrash;
}

}  // namespace

Outcome run_apart(const std::function<std::string()>& check, unsigned seconds) {
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) be_the_child(check, seconds, pipe_ends[1]);
  close(pipe_ends[1]);
  Outcome outcome;
  outcome.problem = read_all(pipe_ends[0]);
  close(pipe_ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  outcome.ending = ending_of(status);
  return outcome;
}

}  // namespace exactff::validation
