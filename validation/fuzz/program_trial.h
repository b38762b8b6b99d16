// Runs a ProgramCase and checks all its results: how the program ends, what it prints, and every file that it leaves.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "fuzz/program_case.h"

namespace exactff::validation {

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
