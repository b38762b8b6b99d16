// Words for command lines that CLI11 refuses: a flag that is not there, or no longer, or one with the wrong number of
// numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace exactff::cli {

// Throws InputError with these faults of the command line, in its order; returns if there is none. `words`: what
// follows the name of the program, beginning with a command.
void refuse_misused_flags(const CLI::App& app, std::span<const std::string> words);

}  // namespace exactff::cli
