#include "support/program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace exactff::validation {

namespace {

std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments) {
  std::string command = quoted(program);
  for (const std::string& argument : arguments) command += ' ' + quoted(argument);
  const TemporaryDirectory folder(memory_folder());
  const std::filesystem::path errors = folder.path() / "stderr";
  command += " 2> " + quoted(errors.string());
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  ProgramRun run;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    run.output.append(buffer.data(), count);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  run.error = text_of(errors);
  std::cerr << run.error;
  return run;
}

RunningProgram::RunningProgram(const std::string& program, const std::vector<std::string>& arguments,
                               std::filesystem::path error_file, const std::function<void()>& prepare)
    : error_file_(std::move(error_file)) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), program);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  child_ = ::fork();
  if (child_ != 0) return;
  if (std::freopen(error_file_.c_str(), "w", stderr) == nullptr) ::_exit(125);
  if (std::freopen("/dev/null", "w", stdout) == nullptr) ::_exit(125);
  prepare();
  ::execv(pointers[0], pointers.data());
  ::_exit(126);
}

void RunningProgram::send(int signal) const { ::kill(child_, signal); }

int RunningProgram::wait() const {
  int status = 0;
  ::waitpid(child_, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool RunningProgram::has_ended() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
}

std::string RunningProgram::error() const {
  std::ostringstream text;
  text << std::ifstream(error_file_).rdbuf();
  return text.str();
}

TemporaryDirectory::TemporaryDirectory(const std::filesystem::path& parent) {
  std::string name = (parent / "exactff_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary directory");
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryDirectory::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return path_ / name;
}

EnvironmentVariable::EnvironmentVariable(std::string name, const std::string& value) : name_(std::move(name)) {
  if (const char* before = std::getenv(name_.c_str())) before_ = before;
  ::setenv(name_.c_str(), value.c_str(), 1);
}

EnvironmentVariable::~EnvironmentVariable() {
  if (before_) {
    ::setenv(name_.c_str(), before_->c_str(), 1);
  } else {
    ::unsetenv(name_.c_str());
  }
}

ProgramRun run_point_plain(const std::string& program, const std::string& name, const generate::PlainScene& scene) {
  constexpr auto kDigits = generate::Digits::kSeventeen;
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.write(name + ".obj", generate::to_obj(scene, "", kDigits));
  std::vector<std::string> arguments{"point", path.string()};
  const auto add = [&](const char* flag, const Vec3& v) {
    arguments.insert(arguments.end(), {flag, generate::to_text(v.x, kDigits), generate::to_text(v.y, kDigits),
                                       generate::to_text(v.z, kDigits)});
  };
  add("--at", scene.point);
  add("--normal", scene.normal);
  arguments.insert(arguments.end(), {"--source", scene.source, "--plain"});
  return run_program(program, arguments);
}

std::filesystem::path memory_folder() {
  const std::filesystem::path memory = "/dev/shm";
  return ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return std::move(text).str();
}

std::uintmax_t size_of(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  return ignored ? 0 : size;
}

}  // namespace exactff::validation
