// Formats the texts of --help from the option tables. (`exactff help` is in help_command.cpp.)
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace exactff::cli {

// For App::formatter. Set it before commands are added, because they inherit it.
[[nodiscard]] std::shared_ptr<CLI::Formatter> help_formatter();

// Throws InputError if there is no such command. `app` must have all commands: main() adds them first.
void require_command(const CLI::App& app, const std::string& name);

}  // namespace exactff::cli
