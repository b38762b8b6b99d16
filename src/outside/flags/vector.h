// Flags that take three numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <string>

#include "exactff/geometry.h"

namespace exactff::flags {

// As given; empty texts if the flag was not. CLI11 always gives an array all its words, so "-.5" is no flag.
using ThreeNumbers = std::array<std::string, 3>;
[[nodiscard]] inline bool is_given(const ThreeNumbers& numbers) { return !numbers.front().empty(); }

CLI::Option* add_vector_option(CLI::App& app, const std::string& flag, ThreeNumbers& numbers,
                               const std::string& meaning, const std::string& type = "X Y Z");

// Parses finite doubles with correct rounding. The InputError for other texts names the flag.
[[nodiscard]] Vec3 vector_of(const ThreeNumbers& numbers, const std::string& flag);

}  // namespace exactff::flags
