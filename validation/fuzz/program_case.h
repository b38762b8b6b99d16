// One run of the whole program as a case that can be kept and replayed: input files, command lines, and a disturbance
// of the last command while it runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/odd_commands.h"
#include "fuzz/odd_files.h"

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

// Writes a folder from which read_case() makes the same case: the files, and a file `case` with one word per line.
void keep_case(const ProgramCase& one, const std::filesystem::path& folder);
[[nodiscard]] ProgramCase read_case_folder(const std::filesystem::path& folder);

// The disturbance of the last command in words, such as "signal 12 2".
[[nodiscard]] std::string disturbance_words(const ProgramCase& one);

// The words quoted for a shell.
[[nodiscard]] std::string command_line(const Words& words);

}  // namespace exactff::validation
