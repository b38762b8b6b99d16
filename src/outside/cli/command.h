// The commands of the program. Each file parses its own flags, calls the library and prints; no mathematics.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace exactff::cli {

// Registers the command with `app` and returns the function that runs it. That function returns the exit code: 0 done,
// 1 a check failed, 2 bad input (by InputError), 3 not as accurate or certified as asked, 4 internal.
struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

Command add_info(CLI::App& app);
Command add_point(CLI::App& app);
Command add_view(CLI::App& app);
Command add_matrix(CLI::App& app);
Command add_radiosity(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_truth(CLI::App& app);
Command add_merge(CLI::App& app);
Command add_check(CLI::App& app);
Command add_render(CLI::App& app);
Command add_stress(CLI::App& app);
Command add_convert(CLI::App& app);
Command add_help(CLI::App& app);
Command add_completion(CLI::App& app);

// All commands, in the order of the help.
std::vector<Command> add_commands(CLI::App& app);

// For App::formatter: forms the texts of --help from the option tables. Set it before commands are added, because they
// inherit it.
[[nodiscard]] std::shared_ptr<CLI::Formatter> help_formatter();

// Throws InputError if there is no such command. `app` must have all commands: main() adds them first.
void require_command(const CLI::App& app, const std::string& name);

}  // namespace exactff::cli
