// All commands of the program, and those that explain it: `exactff help`, and `exactff completion`, which is not
// listed, since only the installation calls it.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "cli/option_table.h"
#include "cli/output.h"
#include "flags/values.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {
namespace {

// --- help ---

constexpr std::size_t kIndent = 30;
constexpr std::size_t kLineLength = 120;

std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string result, word;
  for (std::size_t column = 0; words >> word; column += word.size()) {
    const bool breaks = column > 0 && column + 1 + word.size() > width;
    if (breaks) column = 0;
    if (column > 0) ++column;
    result += (result.empty() ? "" : breaks ? "\n" : " ") + word;
  }
  return result;
}

// CLI11's own formatter would print "TEXT:{edges,boolean,both}=edges" and not wrap long lines.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kIndent); }

  std::string make_usage(const CLI::App* app, std::string name) const override {
    return "\n" + Formatter::make_usage(app, std::move(name));
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const OptionRow row = option_row(*option);
    return option->get_positional() || row.value.empty() ? "" : " " + row.value;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const bool tells = option->get_required() && !option->get_positional();
    return wrapped(option_row(*option).description + (tells ? " (required)" : ""), kLineLength - kIndent);
  }
};

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

// --- completion ---

std::string single_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string join_by_spaces(const std::vector<std::string>& words) { return text::joined(words, " "); }

std::vector<std::string> command_names(const ProgramTable& program) {
  std::vector<std::string> names;
  for (const CommandTable& command : program.commands) names.push_back(command.name);
  return names;
}

std::string option_names(const CommandTable& command) {
  std::vector<std::string> names;
  for (const OptionRow& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return join_by_spaces(names);
}

// The words before the cursor determine what it is at: the last option, and how many values it already has. Bash splits
// "--engine=edges" into three words and "@teapot" into two, but replaces both of the latter. A word such as -0.5 is a
// value. Completion of files is left to readline, which knows about quotes. Of a comma list, the last name is
// completed.
constexpr const char* kBashFunction = R"(
_exactff() {
  local cur=${COMP_WORDS[COMP_CWORD]} command='' option='' values=0 most=0 offer='' options='' index word before=''
  COMPREPLY=()
  for ((index = 1; index < COMP_CWORD; ++index)); do
    word=${COMP_WORDS[index]}
    case $word in
      =) ;;
      -[!0-9.]*) option=$word values=0 ;;
      *) if [[ -z $command ]]; then command=$word; else ((++values)); fi ;;
    esac
  done
  [[ $cur == = ]] && cur=''
  [[ ${COMP_WORDS[COMP_CWORD - 1]} == @ ]] && cur=@$cur

  _exactff_command "$command"
  [[ -n $option ]] && _exactff_option "$command $option"
  if [[ -n $option ]] && ((values < most)); then
    :
  elif [[ $cur == -* ]]; then
    offer=$options
  else
    _exactff_argument "$command"
  fi
  case $offer in
    '') ;;
    FILES) compopt -o default ;;
    FOLDERS) compopt -o dirnames ;;
    'FILES '*)
      if [[ $cur == @* ]]; then COMPREPLY=($(compgen -W "${offer#FILES }" -- "$cur")); else compopt -o default; fi
      ;;
    'LIST '*)
      [[ $cur == *,* ]] && before=${cur%,*},
      COMPREPLY=($(compgen -P "$before" -W "${offer#LIST }" -- "${cur##*,}"))
      ;;
    *) COMPREPLY=($(compgen -W "$offer" -- "$cur")) ;;
  esac
}
complete -F _exactff exactff
)";

std::string bash_offer(const OptionRow& row) {
  switch (row.completion) {
    case Completion::kChoices:
      return single_quoted(join_by_spaces(row.choices));
    case Completion::kWords:
      return single_quoted("LIST " + join_by_spaces(row.words));
    case Completion::kFiles:
      return "FILES";
    case Completion::kFilesAndModels:
      return single_quoted("FILES " + join_by_spaces(row.words));
    case Completion::kFolders:
      return "FOLDERS";
    case Completion::kNothing:
      break;
  }
  return "''";
}

std::string bash_case(const std::string& pattern, const std::string& body) {
  return fmt::format("    {}) {} ;;\n", pattern, body);
}

std::string bash_values(const CommandTable& command) {
  std::string lines;
  for (const OptionRow& option : command.options) {
    std::string pattern;
    for (const std::string& name : option.names) {
      pattern += (pattern.empty() ? "" : " | ") + single_quoted(command.name + " " + name);
    }
    if (option.most_values > 0) {
      lines += bash_case(pattern, fmt::format("most={} offer={}", option.most_values, bash_offer(option)));
    }
  }
  return lines;
}

std::string bash_function(const std::string& name, const std::string& cases) {
  return fmt::format("\n{}() {{\n  case $1 in\n{}  esac\n}}\n", name, cases);
}

std::string bash_completion(const ProgramTable& program) {
  std::string options = bash_case("''", "options=" + single_quoted(option_names(program.top)));
  std::string arguments = bash_case("''", "offer=" + single_quoted(join_by_spaces(command_names(program))));
  std::string values;
  for (const CommandTable& command : program.commands) {
    options += bash_case(command.name, "options=" + single_quoted(option_names(command)));
    if (!command.positionals.empty()) {
      arguments += bash_case(command.name, "offer=" + bash_offer(command.positionals.front()));
    }
    values += bash_values(command);
  }
  return "# bash completion of exactff, written by the program from its own options: exactff completion bash\n" +
         bash_function("_exactff_command", options) + bash_function("_exactff_argument", arguments) +
         bash_function("_exactff_option", values) + kBashFunction;
}

}  // namespace

std::shared_ptr<CLI::Formatter> help_formatter() { return std::make_shared<HelpFormatter>(); }

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

Command add_completion(CLI::App& app) {
  struct Arguments {
    std::string shell, file;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("completion", "Print the script for command-line completion in a shell")->group("");
  command->add_option("SHELL", args->shell, "bash")->required()->check(CLI::IsMember({"bash"}));
  flags::add_written(*command, "-o,--output", args->file, "File to write instead of standard output",
                     flags::Format::kAny);
  return {command, [args, &app] {
            const std::string script = bash_completion(program_table(app));
            if (!args->file.empty()) {
              write_whole_file(args->file, script);
            } else {
              std::cout << script;
              check_output(std::cout);
            }
            return 0;
          }};
}

std::vector<Command> add_commands(CLI::App& app) {
  return {add_info(app),   add_point(app),   add_view(app),  add_matrix(app),    add_radiosity(app),
          add_render(app), add_compare(app), add_truth(app), add_merge(app),     add_check(app),
          add_stress(app), add_convert(app), add_help(app),  add_completion(app)};
}

}  // namespace exactff::cli
