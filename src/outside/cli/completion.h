// Completion of command lines in shells, generated from the program's own options.
#pragma once

#include <string>

#include "cli/option_table.h"

namespace exactff::cli {

// Each result is a file to be sourced, or to be put where the shell looks for completions.
[[nodiscard]] std::string bash_completion(const ProgramTable& program);
[[nodiscard]] std::string zsh_completion(const ProgramTable& program);
[[nodiscard]] std::string fish_completion(const ProgramTable& program);

}  // namespace exactff::cli
