// fuzz_program [--seconds N] [--runs N] [--seed S] [--keep FOLDER]
// fuzz_program --replay FOLDER
// Both accept --program FILE, to run the program of another build.
//
// Runs the whole program on random scenes and files (odd_files.h) with random command lines from its own option tables
// (odd_commands.h), as a user would. Some runs are interrupted, or have little memory or disk space. Each run must end
// without a signal, in time, and with a documented exit code. Bad input must be reported. Printed and written output
// must be valid (output_judge.py), and complete or absent. A second run must give the same bytes.
//
// This is a separate program and not a libFuzzer target, because libFuzzer would not see the coverage of a process that
// it starts. It also accepts the optimised build, which runs far more cases per second. Cases depend only on the seed
// and their number.
//
// A finding is shortened word by word and kept in FOLDER with its files and command lines: one of each kind, and the
// number of times that it occurred. The exit code is 1 if there is a finding.
#include <algorithm>
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
#include "unit/outside/sanitized.h"

namespace exactff::validation {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using generate::Random;

struct Arguments {
  double seconds = 1e9;
  std::uint64_t runs = ~std::uint64_t{0};
  std::uint64_t seed = 1;
  fs::path keep = "findings";
  std::string replay;
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

class Fuzzer {
 public:
  explicit Fuzzer(Arguments arguments) : arguments_(std::move(arguments)), least_memory_(least_megabytes(bench_)) {}

  int fuzz() {
    const auto start = Clock::now();
    for (; runs_ < arguments_.runs; ++runs_) {
      if (std::chrono::duration<double>(Clock::now() - start).count() > arguments_.seconds) break;
      const ProgramCase one = make_case(runs_);
      const std::string problem = problem_of(one, bench_, judge_);
      if (!problem.empty()) take(one, problem);
    }
    return report();
  }

  int replay() {
    const ProgramCase one = read_case_folder(arguments_.replay);
    for (const Words& words : one.commands) std::cout << command_line(words) << '\n';
    const std::string problem = problem_of(one, bench_, judge_);
    std::cout << (problem.empty() ? "clean" : problem) << '\n' << text_of(bench_.scratch / "first" / "stderr");
    return problem.empty() ? 0 : 1;
  }

 private:
  [[nodiscard]] ProgramCase make_case(std::uint64_t number) const {
    Random random(Random(arguments_.seed).bits() ^ Random(number).bits());
    const OddInputs inputs = odd_inputs(random);
    ProgramCase one{.files = inputs.files, .commands = odd_commands(table_, inputs, random)};
    disturb(one, least_memory_, random);
    return one;
  }

  void take(const ProgramCase& found, const std::string& problem) {
    const std::string kind = kind_of(problem);
    if (++kinds_[kind] > 1) return;
    const ProgramCase one = shortened(found, kind);
    const fs::path folder =
        arguments_.keep / ("program-" + std::to_string(arguments_.seed) + '-' + std::to_string(runs_));
    keep_case(one, folder);
    std::cout << "FINDING " << problem << "\n  " << command_line(one.commands.back()) << "  # "
              << disturbance_words(one) << "\n  replay: fuzz_program --replay " << folder.string() << std::endl;
  }

  // Removes everything that the problem does not need: the disturbance, steps, words, files. Stops if this takes too
  // long.
  ProgramCase shortened(ProgramCase one, const std::string& kind) {
    const auto still = [&](const ProgramCase& smaller) { return kind_of(problem_of(smaller, bench_, judge_)) == kind; };
    const auto start = Clock::now();
    const auto attempt = [&](const auto& change) {
      if (Clock::now() - start > std::chrono::seconds(30)) return;
      ProgramCase smaller = one;
      change(smaller);
      if (still(smaller)) one = std::move(smaller);
    };
    if (one.disturbance == Disturbance::kSignal || kind.find("not end") != std::string::npos) return one;
    attempt([](ProgramCase& c) { c.disturbance = Disturbance::kNone; });
    for (std::size_t i = one.commands.size() - 1; i-- > 0;) {
      attempt([i](ProgramCase& c) { c.commands.erase(c.commands.begin() + static_cast<std::ptrdiff_t>(i)); });
    }
    for (const std::size_t length : {2U, 1U, 4U}) shorten_words(attempt, one, length);
    for (const auto& file : Files(one.files)) {
      attempt([&file](ProgramCase& c) { c.files.erase(file.first); });
    }
    return one;
  }

  template <class Attempt>
  static void shorten_words(const Attempt& attempt, const ProgramCase& one, std::size_t length) {
    for (std::size_t at = one.commands.back().size(); at-- > 1;) {
      if (at + length > one.commands.back().size()) continue;
      attempt([=](ProgramCase& c) {
        const auto first = c.commands.back().begin() + static_cast<std::ptrdiff_t>(at);
        c.commands.back().erase(first, first + static_cast<std::ptrdiff_t>(length));
      });
    }
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
    else if (flag == "--runs")
      arguments.runs = number<std::uint64_t>(value);
    else if (flag == "--seed")
      arguments.seed = number<std::uint64_t>(value);
    else if (flag == "--keep")
      arguments.keep = value;
    else if (flag == "--program")
      arguments.program = value;
    else if (flag == "--replay")
      arguments.replay = value;
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
    const Arguments arguments = parsed(argc, argv);
    return arguments.replay.empty() ? Fuzzer(arguments).fuzz() : Fuzzer(arguments).replay();
  } catch (const std::exception& error) {
    std::cerr << "fuzz_program: " << error.what() << '\n';
    return 2;
  }
}
