// One run of the whole program, as a case that can be kept and replayed: input files, command lines, and what happens
// to the last of them while it runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/odd_commands.h"
#include "fuzz/odd_files.h"

namespace exactff::validation {

enum class Disturbance {
  kNone,
  kTwice,         // run again elsewhere, with `amount` threads where the command has them: the same bytes
  kSignal,        // `signal` after `amount` ms, then, where the command can be resumed, it is
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

// A folder from which read_case() makes the same case: the files, and a file `case` of one word a line.
void keep_case(const ProgramCase& one, const std::filesystem::path& folder);
[[nodiscard]] ProgramCase read_case_folder(const std::filesystem::path& folder);

// What happens to the last command, such as "signal 12 2".
[[nodiscard]] std::string disturbance_words(const ProgramCase& one);

// For a shell.
[[nodiscard]] std::string command_line(const Words& words);

}  // namespace exactff::validation
