// The texts of --help, laid out from the option tables.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

namespace exactff::cli {

// For App::formatter, before commands are added: these inherit it.
[[nodiscard]] std::shared_ptr<CLI::Formatter> help_formatter();

}  // namespace exactff::cli
