// exactff_minimise [-o FOLDER] INPUT...
//
// Shrinks failing inputs and writes each as a regression case. If that case is moved into data/regression, it becomes a
// test. An input is a case file (.json), or a file for which fuzz_solver fails with a wrong value, a crash or a hang.
// Exit code 0: every input fails and was shrunk; 1: one does not fail (here); 2: bad input.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "fuzz/scene_bytes.h"
#include "support/case_file.h"
#include "support/minimise.h"
#include "support/oracle_check.h"

namespace exactff::validation {

namespace {

using generate::PlainScene;

constexpr unsigned kSeconds = 20;  // for one scene

// By default, sanitizers end a process with exit code 1.
constexpr int kFineCode = 90;
constexpr int kWrongCode = 91;

enum class Ending { kFine, kWrong, kCrash, kHang };

// An exception must not leave this function, because the frames of the caller belong to the parent process.
[[noreturn]] void be_the_child(const PlainScene& scene) noexcept {
  for (const int number : {SIGALRM, SIGABRT, SIGSEGV, SIGFPE}) std::signal(number, SIG_DFL);
  alarm(kSeconds);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  _exit(disagreement(scene).empty() ? kFineCode : kWrongCode);
}

// In a separate process, so that a crash or a hang is just another ending.
Ending ending_of(const PlainScene& scene) {
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) be_the_child(scene);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGALRM ? Ending::kHang : Ending::kCrash;
  const int code = WEXITSTATUS(status);
  return code == kFineCode ? Ending::kFine : code == kWrongCode ? Ending::kWrong : Ending::kCrash;
}

std::optional<PlainScene> read_input(const std::filesystem::path& path) {
  if (path.extension() == ".json") return read_case(path).scene;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) throw std::runtime_error("cannot read " + path.string());
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  auto decoded = decode(bytes);
  return decoded ? std::optional(std::move(decoded->scene)) : std::nullopt;
}

// Writes NAME.json, a case for data/regression with the oracle's result as expected value, and NAME.obj for viewing.
// Returns the path of the case.
std::filesystem::path keep(const PlainScene& scene, const std::string& problem, const std::string& name,
                           const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  try {
    std::ofstream(folder / (name + ".obj")) << generate::to_obj(scene);
  } catch (const std::invalid_argument&) {  // touching rings cannot become keyholes; there is only the case file
  }
  const std::filesystem::path path = folder / (name + ".json");
  std::ofstream out(path);
  out << to_json(as_case(name, scene), "found by fuzzing: " + problem);
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
  return path;
}

// True if the input fails. Smaller scenes must fail in the same way: shrinking does not go from a disagreement to a
// crash, or from a crash to a hang.
bool minimise(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const std::optional<PlainScene> scene = read_input(path);
  const Ending ending = scene ? ending_of(*scene) : Ending::kFine;
  if (ending == Ending::kFine) {
    std::cout << path.string() << ": does not fail\n";
    return false;
  }
  const PlainScene small = minimised(*scene, [&](const PlainScene& smaller) { return ending_of(smaller) == ending; });
  const std::string problem = ending == Ending::kCrash  ? "crashes"
                              : ending == Ending::kHang ? "hangs"
                                                        : disagreement(small);
  const std::filesystem::path kept = keep(small, problem, test_name(path.stem().string()), folder);
  std::cout << path.string() << ": " << problem << "; shrunk to " << kept.string() << std::endl;
  return true;
}

int run(const std::vector<std::string>& arguments) {
  std::filesystem::path folder = ".";
  std::vector<std::filesystem::path> inputs;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] != "-o") {
      inputs.emplace_back(arguments[i]);
    } else if (++i < arguments.size()) {
      folder = arguments[i];
    }
  }
  if (inputs.empty()) throw std::runtime_error("usage: exactff_minimise [-o FOLDER] INPUT...");
  bool all_fail = true;
  for (const std::filesystem::path& input : inputs) all_fail = minimise(input, folder) && all_fail;
  return all_fail ? 0 : 1;
}

}  // namespace

}  // namespace exactff::validation

int main(int argc, char** argv) {
  try {
    return exactff::validation::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
