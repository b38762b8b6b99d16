// Flags that take three numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "exactff/geometry.h"

namespace exactff::flags {

using ThreeNumbers = std::vector<std::string>;  // as given; empty if the flag was not

CLI::Option* add_vector_option(CLI::App& app, const std::string& flag, ThreeNumbers& numbers,
                               const std::string& meaning, const std::string& type = "X Y Z");

// Parses finite doubles with correct rounding. The InputError for other texts names the flag.
[[nodiscard]] Vec3 vector_of(const ThreeNumbers& numbers, const std::string& flag);

}  // namespace exactff::flags
