// fuzz_program [--seconds N] [--first N] [--runs N] [--seed S] [--keep FOLDER] [--program FILE]
//
// Runs the whole program on random scenes and files (odd_files.h) with random command lines from its own option tables
// (odd_commands.h), as a user would. Some runs are interrupted, or have little memory or disk space. Each run must end
// without a signal, in time, and with a documented exit code. Bad input must be reported. Printed and written output
// must be valid (output_judge.py), and complete or absent. A second run must give the same bytes.
//
// This is a separate program and not a libFuzzer target, because libFuzzer would not see the coverage of a process that
// it starts. It also accepts the optimised build, which runs far more cases per second.
//
// A finding is kept in FOLDER with its files and printed with its command lines: one of each kind, and the number of
// times that it occurred. Cases depend only on the seed and their number, so `--first N --runs 1` repeats one. The exit
// code is 1 if there is a finding.
#include <array>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <iostream>
#include <map>
#include <regex>
#include <string>
#include <string_view>

#include "fuzz/program_trial.h"
#include "support/program.h"
#include "support/random_scenes.h"
#include "text/escape.h"
#include "unit/outside/sanitized.h"

namespace exactff::validation {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using generate::Random;

struct Arguments {
  double seconds = 1e9;
  std::uint64_t first = 0;
  std::uint64_t runs = ~std::uint64_t{0};
  std::uint64_t seed = 1;
  fs::path keep = "findings";
  std::string program = EXACTFF_PROGRAM;
};

void disturb(ProgramCase& one, int least_memory, Random& random) {
  if (random.one_in(2)) return;
  one.disturbance = static_cast<Disturbance>(1 + random.below(kDisturbanceCount - 1));
  switch (one.disturbance) {
    case Disturbance::kTwice:
      one.amount = random.integer(1, 4);
      return;
    case Disturbance::kSignal:
      one.amount = random.one_in(3) ? random.integer(0, 400) : random.integer(0, 40);
      one.signal = one_of<int>(random, {SIGINT, SIGINT, SIGTERM, SIGHUP, SIGKILL});
      return;
    case Disturbance::kLittleMemory:
      if (kSanitized) one.disturbance = Disturbance::kNone;
      one.amount = least_memory + random.integer(0, 60);
      return;
    case Disturbance::kFullDisk:
      one.amount = one_of<int>(random, {600, 2048, 10000, 100000});
      return;
    case Disturbance::kNone:
    case Disturbance::kFullOutput:
      return;
  }
}

// The kind of a finding: its text without names and numbers.
std::string kind_of(const std::string& problem) {
  static const std::regex kParticular(R"(0x[0-9a-f]+|[-+.]?\d+|'[^']*'|folder/[^:]*)");
  constexpr std::size_t kLongest = 500;  // std::regex needs stack for every character of a quoted name
  return std::regex_replace(problem.substr(0, kLongest), kParticular, "*");
}

std::string command_line(const Words& words) {
  std::string line = "exactff";
  for (const std::string& word : words) line += ' ' + text::shell_word(word);
  return line;
}

class Fuzzer {
 public:
  explicit Fuzzer(Arguments arguments) : arguments_(std::move(arguments)), least_memory_(least_megabytes(bench_)) {}

  int fuzz() {
    const auto start = Clock::now();
    for (; runs_ < arguments_.runs; ++runs_) {
      if (std::chrono::duration<double>(Clock::now() - start).count() > arguments_.seconds) break;
      const std::uint64_t number = arguments_.first + runs_;
      const ProgramCase one = make_case(number);
      const std::string problem = problem_of(one, bench_, judge_);
      if (!problem.empty() && ++kinds_[kind_of(problem)] == 1) take(one, problem, number);
    }
    return report();
  }

 private:
  [[nodiscard]] ProgramCase make_case(std::uint64_t number) const {
    Random random(Random(arguments_.seed).bits() ^ Random(number).bits());
    const OddInputs inputs = odd_inputs(random);
    ProgramCase one{.files = inputs.files, .commands = odd_commands(table_, inputs, random)};
    disturb(one, least_memory_, random);
    return one;
  }

  void take(const ProgramCase& one, const std::string& problem, std::uint64_t number) {
    static constexpr std::array<const char*, kDisturbanceCount> kNames = {"none",          "twice",     "signal",
                                                                          "little memory", "full disk", "full output"};
    const std::string of = "--seed " + std::to_string(arguments_.seed) + " --first " + std::to_string(number);
    const fs::path folder =
        arguments_.keep / ("program-" + std::to_string(arguments_.seed) + '-' + std::to_string(number));
    std::error_code ignored;  // some files may not be read
    fs::create_directories(folder, ignored);
    fs::copy(bench_.scratch, folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing, ignored);
    std::cout << "FINDING " << problem << "\n";
    for (const Words& words : one.commands) std::cout << "  " << command_line(words) << '\n';
    std::cout << "  disturbance: " << kNames.at(static_cast<std::size_t>(one.disturbance)) << ' ' << one.amount << ' '
              << one.signal << "; files: " << folder.string() << "\n  replay: fuzz_program " << of << " --runs 1"
              << std::endl;
  }

  [[nodiscard]] int report() const {
    std::cout << runs_ << " cases of seed " << arguments_.seed << '\n';
    for (const auto& [kind, count] : kinds_) std::cout << count << " times: " << kind << '\n';
    return kinds_.empty() ? 0 : 1;
  }

  Arguments arguments_;
  const TemporaryDirectory place_{memory_folder()};
  const Bench bench_{arguments_.program, place_.path() / "case"};
  const int least_memory_;
  const cli::ProgramTable table_ = own_table();
  OutputJudge judge_;
  std::uint64_t runs_ = 0;
  std::map<std::string, std::uint64_t> kinds_;
};

template <class Number>
Number number(const char* text) {
  Number value{};
  const auto end = std::from_chars(text, text + std::strlen(text), value);
  if (end.ec != std::errc{} || *end.ptr != '\0') throw std::runtime_error(std::string("no number: ") + text);
  return value;
}

Arguments parsed(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view flag = argv[i];
    const char* value = argv[i + 1];
    if (flag == "--seconds")
      arguments.seconds = number<double>(value);
    else if (flag == "--first")
      arguments.first = number<std::uint64_t>(value);
    else if (flag == "--runs")
      arguments.runs = number<std::uint64_t>(value);
    else if (flag == "--seed")
      arguments.seed = number<std::uint64_t>(value);
    else if (flag == "--keep")
      arguments.keep = value;
    else if (flag == "--program")
      arguments.program = value;
    else
      throw std::runtime_error("no such option: " + std::string(flag));
  }
  if (argc % 2 == 0) throw std::runtime_error("an option without a value");
  return arguments;
}

}  // namespace
}  // namespace exactff::validation

int main(int argc, char** argv) {
  using namespace exactff::validation;
  try {
    return Fuzzer(parsed(argc, argv)).fuzz();
  } catch (const std::exception& error) {
    std::cerr << "fuzz_program: " << error.what() << '\n';
    return 2;
  }
}
