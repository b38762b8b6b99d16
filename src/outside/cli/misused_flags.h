// Words for command lines that CLI11 refuses or would misread: a flag that is not there, or one without
// its value, or with the wrong number of numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace exactff::cli {

// Before parsing: throws InputError if a flag that takes a value is followed by another flag, which CLI11 would take
// for the value, or by nothing. `words`: what follows the name of the program, beginning with a command.
void refuse_flags_without_values(const CLI::App& app, std::span<const std::string> words);

// Throws InputError with these faults of the command line, in its order; returns if there is none.
void refuse_misused_flags(const CLI::App& app, std::span<const std::string> words);

}  // namespace exactff::cli
