// exactff help: what --help prints; and the answer to a misspelt command.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "cli/help.h"
#include "cli/output.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {
namespace {

std::vector<const CLI::App*> listed_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

const CLI::App* command_named(const CLI::App& app, const std::string& name) {
  const auto found = app.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

bool is_a_scene(const std::string& word) {
  std::error_code ignored;
  return word.starts_with('@') || std::filesystem::is_regular_file(word, ignored);
}

[[noreturn]] void refuse_command(const CLI::App& app, const std::string& word) {
  constexpr std::size_t kFarthest = 3;
  std::vector<std::string> names;
  for (const CLI::App* command : listed_commands(app)) names.push_back(command->get_name());
  const std::vector<std::string_view> known(names.begin(), names.end());
  const std::string_view nearest = text::nearest_names(known, word, 1).front();
  std::string suggestion = "`exactff help` explains them";
  if (is_a_scene(word)) {
    suggestion = "give the command first, for example exactff info SCENE";
  } else if (text::edit_distance(nearest, text::in_lower_case(word), kFarthest) <= kFarthest) {
    suggestion = "did you mean " + std::string(nearest) + "?";
  }
  text::refuse("there is no command " + text::in_quotes(word), "the commands are " + text::enumerate(names),
               suggestion);
}

int print_help(const CLI::App& app, const std::string& command) {
  const auto normal = CLI::AppFormatMode::Normal;
  std::cout << (command.empty() ? app.get_formatter()->make_help(&app, app.get_name(), normal)
                                : command_named(app, command)->help(app.get_name(), normal));
  check_output(std::cout);
  return 0;
}

}  // namespace

void require_command(const CLI::App& app, const std::string& name) {
  if (command_named(app, name) == nullptr) refuse_command(app, name);
}

Command add_help(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("help", "Explain a command and its flags, as its --help does");
  command->add_option("COMMAND", *name, "The command; without it, the program is explained");
  return {command, [name, &app] {
            if (!name->empty()) require_command(app, *name);
            return print_help(app, *name);
          }};
}

}  // namespace exactff::cli
