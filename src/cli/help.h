// Formats the texts of --help from the option tables.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

namespace exactff::cli {

// For App::formatter. Set it before commands are added, because they inherit it.
[[nodiscard]] std::shared_ptr<CLI::Formatter> help_formatter();

}  // namespace exactff::cli
