// One run of the whole program: input files, command lines, and a disturbance of the last command while it runs. A
// trial checks all its results: how the program ends, what it prints, and every file that it leaves.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/odd_commands.h"

namespace exactff::validation {

enum class Disturbance {
  kNone,
  kTwice,         // run again elsewhere, with `amount` threads if the command has them: must give the same bytes
  kSignal,        // `signal` after `amount` ms; then the command is resumed, if it can be
  kLittleMemory,  // `amount` MB of address space
  kFullDisk,      // no file beyond `amount` bytes
  kFullOutput,    // standard output cannot be written
};
inline constexpr std::size_t kDisturbanceCount = 6;

struct ProgramCase {
  Files files;
  std::vector<Words> commands;
  Disturbance disturbance = Disturbance::kNone;
  int amount = 0;
  int signal = 0;
};

// Keeps output_judge.py running: starting the interpreter takes longer than most commands.
class OutputJudge {
 public:
  OutputJudge();
  ~OutputJudge();
  OutputJudge(const OutputJudge&) = delete;
  OutputJudge& operator=(const OutputJudge&) = delete;

  // A description of the problem; empty if there is none.
  [[nodiscard]] std::string judge(const std::filesystem::path& folder, const std::string& form, int exit_code);

 private:
  pid_t process_ = 0;
  std::FILE* questions_ = nullptr;
  std::FILE* answers_ = nullptr;
};

// The program and the place to run it: folders below `scratch` are created and removed.
struct Bench {
  std::string program;
  std::filesystem::path scratch;
};

// A description of the problem in one line that begins with the command; empty if there is none.
[[nodiscard]] std::string problem_of(const ProgramCase& one, const Bench& bench, OutputJudge& judge);

// The smallest address space in MB in which the program starts.
[[nodiscard]] int least_megabytes(const Bench& bench);

}  // namespace exactff::validation
