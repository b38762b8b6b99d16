// Bash gets tables as `case` statements and a function that finds out which value the cursor is at. zsh and fish have
// their own languages for this, so for these there are only tables.
#include "cli/completion.h"

#include "text/names.h"

namespace exactff::cli {
namespace {

std::string single_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string with_backslashes(const std::string& text, std::string_view before) {
  std::string result;
  for (const char c : text) {
    if (before.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
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

// What the shell is told, by what the option takes.
struct Offers {
  std::string choices, words, files, files_and_models, folders, nothing;
};

std::string by_completion(const OptionRow& row, const Offers& offers) {
  switch (row.completion) {
    case Completion::kChoices:
      return offers.choices;
    case Completion::kWords:
      return offers.words;
    case Completion::kFiles:
      return offers.files;
    case Completion::kFilesAndModels:
      return offers.files_and_models;
    case Completion::kFolders:
      return offers.folders;
    case Completion::kNothing:
      break;
  }
  return offers.nothing;
}

// --- bash ---

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
  return by_completion(row, {.choices = single_quoted(join_by_spaces(row.choices)),
                             .words = single_quoted("LIST " + join_by_spaces(row.words)),
                             .files = "FILES",
                             .files_and_models = single_quoted("FILES " + join_by_spaces(row.words)),
                             .folders = "FOLDERS",
                             .nothing = "''"});
}

std::string bash_case(const std::string& pattern, const std::string& body) {
  return "    " + pattern + ") " + body + " ;;\n";
}

std::string bash_values(const CommandTable& command) {
  std::string lines;
  for (const OptionRow& option : command.options) {
    std::string pattern;
    for (const std::string& name : option.names) {
      pattern += (pattern.empty() ? "" : " | ") + single_quoted(command.name + " " + name);
    }
    const std::string most = std::to_string(option.most_values);
    if (option.most_values > 0) lines += bash_case(pattern, "most=" + most + " offer=" + bash_offer(option));
  }
  return lines;
}

std::string bash_function(const std::string& name, const std::string& cases) {
  return "\n" + name + "() {\n  case $1 in\n" + cases + "  esac\n}\n";
}

// --- zsh ---

std::string zsh_action(const OptionRow& row) {
  return by_completion(row, {.choices = "(" + join_by_spaces(row.choices) + ")",
                             .words = "_sequence compadd - " + join_by_spaces(row.words),
                             .files = "_files",
                             .files_and_models = "{_files; compadd -- " + join_by_spaces(row.words) + "}",
                             .folders = "_files -/",
                             .nothing = " "});
}

std::string zsh_values(const OptionRow& row) {
  const std::string value = ":" + with_backslashes(row.value, ":\\") + ":" + zsh_action(row);
  std::string text;
  for (int i = 0; i < row.least_values; ++i) text += value;
  return text;
}

// (NAMES)'NAME[description]:value:action', once for each name of the option.
std::string zsh_option(const OptionRow& option) {
  std::string lines;
  const std::string others = option.repeats ? "'*'" : single_quoted("(" + join_by_spaces(option.names) + ")");
  for (const std::string& name : option.names) {
    lines += " \\\n        " + others +
             single_quoted(name + "[" + with_backslashes(option.description, "[]\\") + "]" + zsh_values(option));
  }
  return lines;
}

std::string zsh_arguments(const CommandTable& command) {
  std::string text = "_arguments -C";
  for (const OptionRow& option : command.options) text += zsh_option(option);
  for (const OptionRow& positional : command.positionals) {
    text += " \\\n        " + single_quoted((positional.repeats ? "*" : "") + zsh_values(positional));
  }
  return text;
}

std::string zsh_command(const CommandTable& command) {
  return "      " + command.name + ")\n        " + zsh_arguments(command) + " ;;\n";
}

constexpr const char* kZshHead = R"(#compdef exactff
# zsh completion of exactff, written by the program from its own options: exactff completion zsh

_exactff() {
  local curcontext=$curcontext state line
  typeset -A opt_args
  local -a commands=()";

constexpr const char* kZshEnd = R"(    esac
  fi
}

# Sourced, or loaded by its name.
if [[ $funcstack[1] == _exactff ]]; then
  _exactff "$@"
else
  compdef _exactff exactff
fi
)";

// --- fish ---

std::string fish_takes(const OptionRow& row) {
  return by_completion(row, {.choices = " -x -a " + single_quoted(join_by_spaces(row.choices)),
                             .words = " -x -a " + single_quoted(join_by_spaces(row.words)),
                             .files = " -r -F",
                             .files_and_models = " -F -a " + single_quoted(join_by_spaces(row.words)),
                             .folders = " -x -a '(__fish_complete_directories)'",
                             .nothing = row.most_values > 0 ? " -x" : ""});
}

std::string fish_text(const std::string& text) { return "'" + with_backslashes(text, "'\\") + "'"; }

std::string fish_option(const OptionRow& option, const std::string& condition) {
  std::string line = "complete -c exactff -n " + condition;
  for (const std::string& name : option.names) {
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return line + fish_takes(option) + " -d " + fish_text(option.description) + "\n";
}

std::string fish_command(const CommandTable& command) {
  const std::string condition = "'__fish_seen_subcommand_from " + command.name + "'";
  std::string lines;
  for (const OptionRow& positional : command.positionals) {
    lines += "complete -c exactff -n " + condition + fish_takes(positional) + "\n";
  }
  for (const OptionRow& option : command.options) lines += fish_option(option, condition);
  return lines;
}

}  // namespace

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

std::string zsh_completion(const ProgramTable& program) {
  std::string names, commands;
  for (const CommandTable& command : program.commands) {
    names += "\n    " + single_quoted(command.name + ":" + with_backslashes(command.description, ":\\"));
    commands += zsh_command(command);
  }
  std::string top = "  " + zsh_arguments(program.top);
  top += " \\\n        '1:command:->command' '*::argument:->argument' && return\n";
  return kZshHead + names + "\n  )\n" + top +
         "  if [[ $state == command ]]; then\n    _describe command commands\n  else\n    case $words[1] in\n" +
         commands + kZshEnd;
}

std::string fish_completion(const ProgramTable& program) {
  std::string text =
      "# fish completion of exactff, written by the program from its own options: exactff completion fish\n"
      "complete -c exactff -f\n";
  for (const OptionRow& option : program.top.options) text += fish_option(option, "__fish_use_subcommand");
  for (const CommandTable& command : program.commands) {
    text += "complete -c exactff -n __fish_use_subcommand -a " + command.name + " -d " +
            fish_text(command.description) + "\n";
  }
  for (const CommandTable& command : program.commands) text += fish_command(command);
  return text;
}

}  // namespace exactff::cli
