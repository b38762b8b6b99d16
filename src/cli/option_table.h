// What CLI11 knows of the program, as plain tables. Help, manual page and completions are all written from these, so
// that none of them can fall behind the options that are parsed.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace exactff::cli {

enum class Completion { kNothing, kChoices, kFiles, kFolders };

struct OptionRow {
  std::vector<std::string> names;    // "-o", "--output"; of a positional argument its name
  std::string value;                 // what stands for it: "NAME[:K]...", "edges|boolean|both"; empty of a flag
  std::vector<std::string> choices;  // if the value is one of a few
  Completion completion = Completion::kNothing;
  int least_values = 0;  // words that follow each time it is given
  int most_values = 0;
  bool repeats = false;
  bool required = false;
  std::string description;  // with range and default
};

struct CommandTable {
  std::string name;
  std::string description;
  std::string footer;
  std::vector<OptionRow> positionals;
  std::vector<OptionRow> options;
};

struct ProgramTable {
  CommandTable top;  // what is given without a command
  std::vector<CommandTable> commands;
};

// Hidden options and commands (of an empty group) are left out.
[[nodiscard]] ProgramTable program_table(const CLI::App& app);
[[nodiscard]] OptionRow option_row(const CLI::Option& option);

}  // namespace exactff::cli
