// The commands of the program. Each file parses its own flags, calls the library and prints; no mathematics.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flags/values.h"

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

// --- Option table ---

// CLI11's description of the program as plain tables. The help, the completion and the words for misused flags are
// generated from these tables, so that they always agree with the options that are parsed.

enum class Completion {
  kNothing,
  kChoices,
  kWords,  // one of `words`, with settings, or several separated by commas
  kFiles,
  kFilesAndModels,  // the models are `words`
  kFolders
};

struct OptionRow {
  std::vector<std::string> names;    // "-o", "--output"; for a positional argument its name
  std::string value;                 // placeholder: "NAME[:K]...", "edges|boolean|both"; empty for a flag
  std::vector<std::string> choices;  // if the value is one of a few
  Completion completion = Completion::kNothing;
  std::vector<std::string> words;  // known names that the value may begin with
  int least_values = 0;            // words that follow each time the option is given
  int most_values = 0;
  bool repeats = false;
  bool required = false;
  std::string description;              // including range and default
  std::optional<flags::FileMark> file;  // if it names one
};

struct CommandTable {
  std::string name;
  std::vector<OptionRow> positionals;
  std::vector<OptionRow> options;
};

struct ProgramTable {
  CommandTable top;  // the program without a command
  std::vector<CommandTable> commands;
};

// Hidden options and commands (those with an empty group) are left out.
[[nodiscard]] ProgramTable program_table(const CLI::App& app);
[[nodiscard]] OptionRow option_row(const CLI::Option& option);

// --- words for command lines that CLI11 refuses or would misread ---

// Before parsing: throws InputError if a flag that takes a value is followed by another flag, which CLI11 would take
// for the value, or by nothing. `words`: what follows the name of the program, beginning with a command.
void refuse_flags_without_values(const CLI::App& app, std::span<const std::string> words);

// Throws InputError with these faults of the command line, in its order; returns if there is none.
void refuse_misused_flags(const CLI::App& app, std::span<const std::string> words);

}  // namespace exactff::cli
