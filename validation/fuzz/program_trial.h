// Runs a ProgramCase and judges all that comes of it: how the program ends, what it says, and every file it leaves.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "fuzz/program_case.h"

namespace exactff::validation {

// output_judge.py, kept running: an interpreter takes longer to start than most commands to run.
class OutputJudge {
 public:
  OutputJudge();
  ~OutputJudge();
  OutputJudge(const OutputJudge&) = delete;
  OutputJudge& operator=(const OutputJudge&) = delete;

  // What is wrong; empty where nothing is.
  [[nodiscard]] std::string judge(const std::filesystem::path& folder, const std::string& form, int exit_code);

 private:
  pid_t process_ = 0;
  std::FILE* questions_ = nullptr;
  std::FILE* answers_ = nullptr;
};

// What is run, and where: folders below `scratch` are made and removed.
struct Bench {
  std::string program;
  std::filesystem::path scratch;
};

// What is wrong, in a line that begins with the command; empty where nothing is.
[[nodiscard]] std::string problem_of(const ProgramCase& one, const Bench& bench, OutputJudge& judge);

// The least address space in MB in which the program starts.
[[nodiscard]] int least_megabytes(const Bench& bench);

}  // namespace exactff::validation
