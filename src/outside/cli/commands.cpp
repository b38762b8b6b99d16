// All commands of the program, and those that explain it: `exactff help`, and `exactff completion`, which is not
// listed, since only the installation calls it.
#include "cli/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string_view>

#include "cli/output.h"
#include "exactff/error.h"
#include "exactff/methods.h"
#include "exactff/models.h"
#include "stress/stress.h"
#include "text/names.h"
#include "text/number_text.h"
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

// --- Option table ---

namespace {

// Larger values mean "no limit": CLI11 uses a large number for it.
constexpr int kManyValues = 1 << 20;

// CLI11 writes a type and its checks as one text: "TEXT:{groups,faces}", "INT:INT in [1 - 4096]", "TEXT:FILE". A colon
// alone does not end the type, since the type may be "NAME[:K]".
struct TypeText {
  std::string type;
  std::string check;  // one of the checks, if there are any
};

TypeText parse_type(const std::string& text) {
  constexpr std::array kChecks = {":{",   ":INT in [", ":UINT in [", ":FLOAT in [",  ":FILE",
                                  ":DIR", ":PATH",     ":POSITIVE",  ":NONNEGATIVE", ":NUMBER"};
  std::size_t end = text.size();
  for (const char* check : kChecks) end = std::min(end, text.find(check));
  return {text.substr(0, end), text.substr(std::min(end + 1, text.size()))};
}

// The text between `open` and `close`; empty if they are not there.
std::string between(const std::string& text, std::string_view open, char close) {
  const std::size_t begin = text.find(open);
  if (begin == std::string::npos) return {};
  const std::size_t from = begin + open.size();
  return text.substr(from, text.find(close, from) - from);
}

// The kind of value that the option takes, as far as its type says. An unspecific type ("TEXT") may be a file.
Completion completion_of(const TypeText& type) {
  for (const std::string& text : {type.check, type.type}) {
    if (text.starts_with("{")) return Completion::kChoices;
    if (text.starts_with("FILE") || text.starts_with("PATH")) return Completion::kFiles;
    if (text.starts_with("DIR")) return Completion::kFolders;
  }
  return type.type == "TEXT" ? Completion::kFiles : Completion::kNothing;
}

// Converts "[1 - 4096]" to " (1 to 4096)".
std::string range_note(const std::string& check) {
  const std::string range = between(check, " in [", ']');
  const std::size_t dash = range.find(" - ");
  if (dash == std::string::npos) return {};
  return fmt::format(" ({} to {})", range.substr(0, dash), range.substr(dash + 3));
}

std::string description_of(const CLI::Option& option, const TypeText& type) {
  std::string text = option.get_description() + range_note(type.check);
  if (!option.get_default_str().empty()) text += " (default: " + option.get_default_str() + ")";
  for (const CLI::Option* other : option.get_excludes()) text += " (not with " + other->get_name() + ")";
  for (const CLI::Option* other : option.get_needs()) text += " (only with " + other->get_name() + ")";
  return text;
}

std::string ellipsis(const OptionRow& row) { return row.most_values == kManyValues ? "..." : ""; }

// What completion offers for a placeholder of an option or the name of a positional argument: FAMILY, METHOD, or SCENE
// (the generated ones, with their @).
std::vector<std::string> known_words(const std::string& kind) {
  std::vector<std::string> words;
  if (kind == "METHOD") {
    for (const methods::Method* method : methods::all_methods()) words.push_back(method->name);
  } else if (kind == "SCENE") {
    for (const models::Model* model : models::all_models()) words.push_back('@' + std::string(model->name));
  } else if (kind == "FAMILY") {
    for (const stress::Family& family : stress::all_families()) words.emplace_back(family.name);
  }
  return words;
}

void offer(std::vector<std::string> words, OptionRow& row) {
  if (words.empty()) return;
  row.words = std::move(words);
  row.completion = row.completion == Completion::kFiles ? Completion::kFilesAndModels : Completion::kWords;
}

// The name of a positional argument says what it is; its type adds nothing.
OptionRow positional_row(const CLI::Option& option) {
  OptionRow row = option_row(option);
  row.names = {option.get_name(true, false)};
  row.value = row.names.front() + ellipsis(row);
  offer(known_words(row.names.front()), row);
  return row;
}

CommandTable command_table(const CLI::App& app) {
  CommandTable table{app.get_name(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) table.positionals.push_back(positional_row(*option));
    if (option->nonpositional()) table.options.push_back(option_row(*option));
  }
  return table;
}

}  // namespace

OptionRow option_row(const CLI::Option& option) {
  const std::string full = option.get_type_name();
  const TypeText type = parse_type(full.substr(0, flags::begin_of_mark(full)));
  OptionRow row;
  row.file = flags::mark_of(option);
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  row.description = description_of(option, type);
  row.required = option.get_required();
  if (option.get_items_expected_max() == 0) return row;  // a flag

  if (const std::string all = between(type.check, "{", '}'); !all.empty()) row.choices = flags::split_list(all);
  row.completion = completion_of(type);
  row.least_values = std::max(1, option.get_items_expected_min());
  row.most_values = std::min(option.get_items_expected_max(), kManyValues);
  row.value = (row.choices.empty() ? type.type : text::joined(row.choices, "|")) + ellipsis(row);
  offer(known_words(type.type), row);
  row.repeats = row.most_values == kManyValues || option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  return row;
}

ProgramTable program_table(const CLI::App& app) {
  ProgramTable table{command_table(app), {}};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) table.commands.push_back(command_table(*command));
  }
  const std::vector<std::string> names = command_names(table);
  for (CommandTable& command : table.commands) {
    for (OptionRow& row : command.positionals) {
      if (row.value != "COMMAND") continue;
      row.words = names;
      row.completion = Completion::kWords;
    }
  }
  return table;
}

// --- words for misused flags ---

namespace {

bool is_number(std::string_view word) { return text::parse_number(word).fault == text::NumberFault::kNone; }

// "-1" and "-.5" are numbers, and "-" is standard input.
bool is_flag(std::string_view word) { return word.size() > 1 && word.front() == '-' && !is_number(word); }

// "--at" of "--at=1,0,1", "-o" of "-oFILE".
std::string_view name_in(std::string_view word) {
  return word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
}

// A word that is meant to be one or more numbers: "1", "1,0,1", "(1,0,1)", "1e-3".
bool looks_like_numbers(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789+-.,;()[]eE") == std::string_view::npos &&
         word.find_first_of("0123456789") != std::string_view::npos;
}

// A flag with what follows it, up to the next flag.
struct GivenFlag {
  std::string name;
  std::vector<std::string> words;

  [[nodiscard]] std::string text() const { return words.empty() ? name : name + ' ' + text::joined(words, " "); }
};

std::vector<GivenFlag> given_flags(std::span<const std::string> words) {
  std::vector<GivenFlag> flags;
  for (const std::string& word : words) {
    if (word == "--") break;  // after it there are no flags
    if (is_flag(word)) {
      const std::string_view name = name_in(word);
      flags.push_back({std::string(name), {}});
      if (name.size() < word.size()) flags.back().words.push_back(word.substr(name.size() + (name.size() > 2 ? 1 : 0)));
    } else if (!flags.empty()) {
      flags.back().words.push_back(word);
    }
  }
  return flags;
}

// The beginning of a name counts as near, too: --out for --output.
std::optional<std::string> nearest_flag(const CommandTable& command, const std::string& name) {
  constexpr std::size_t kFarthest = 2;
  std::vector<std::string_view> names;
  for (const OptionRow& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
  const auto begun = std::ranges::find_if(names, [&](std::string_view known) { return known.starts_with(name); });
  if (begun != names.end()) return std::string(*begun);
  const std::string_view nearest = text::nearest_names(names, name, 1).front();
  if (text::edit_distance(nearest, text::in_lower_case(name), kFarthest) > kFarthest) return std::nullopt;
  return std::string(nearest);
}

Problem unknown(const CommandTable& command, const GivenFlag& flag) {
  const std::optional<std::string> nearest = nearest_flag(command, flag.name);
  return {.what = fmt::format("exactff {} has no flag {}", command.name, flag.name),
          .why = "the command line has " + text::in_quotes(flag.text()),
          .suggestion = nearest ? fmt::format("did you mean {}?", *nearest)
                                : fmt::format("`exactff help {}` lists its flags", command.name)};
}

// The numbers as they should be written; the placeholders if they are not as many as they should be.
std::string with_spaces(const OptionRow& option, const std::vector<std::string>& found) {
  std::string text = text::joined(found, " ");
  for (char& c : text) {
    if (std::string_view(",;()[]").find(c) != std::string_view::npos) c = ' ';
  }
  const std::vector<std::string_view> numbers = text::words(text);
  const bool complete =
      numbers.size() == static_cast<std::size_t>(option.least_values) && std::ranges::all_of(numbers, is_number);
  return complete ? text::joined(numbers, " ") : option.value;
}

// Of a flag that takes a vector: nothing if three numbers follow it.
std::optional<Problem> wrong_count(const OptionRow& option, const GivenFlag& flag) {
  constexpr std::array kNames = {"no", "one", "two", "three", "four"};
  const auto needed = static_cast<std::size_t>(option.least_values);
  const auto end = std::ranges::find_if_not(flag.words, looks_like_numbers);
  const std::vector<std::string> found(flag.words.begin(), end);
  if (found.size() == needed && std::ranges::all_of(found, is_number)) return std::nullopt;
  return Problem{.what = fmt::format("{} takes {} numbers with spaces between them", flag.name, kNames.at(needed)),
                 .why = found.empty() ? "it has none" : "it has " + text::in_quotes(text::joined(found, " ")),
                 .suggestion = fmt::format("write {} {}", flag.name, with_spaces(option, found))};
}

bool takes_a_vector(const OptionRow& option) { return option.least_values == 3 && option.most_values == 3; }

const OptionRow* option_named(const CommandTable& command, const std::string& name) {
  const auto found = std::ranges::find_if(command.options, [&](const OptionRow& option) {
    return std::ranges::find(option.names, name) != option.names.end();
  });
  return found == command.options.end() ? nullptr : &*found;
}

// A value that begins like a flag can be given as --flag=VALUE.
bool is_other_flag(const CommandTable& command, const std::string& word) {
  return is_flag(word) && (word.starts_with("--") || option_named(command, std::string(name_in(word))) != nullptr);
}

std::string kind_of_value(const OptionRow& option) {
  if (option.value.starts_with("NAME")) return "a name";
  if (option.value == "FILE" || option.value == "OUT") return "a file";
  return option.value == "DIR" ? "a folder" : "a value";
}

Problem without_value(const CommandTable& command, const OptionRow& option, const std::string& name,
                      const std::string& next) {
  const bool may_be_meant = !next.empty() && option_named(command, std::string(name_in(next))) == nullptr;
  return {.what = name + " needs " + kind_of_value(option),
          .why = next.empty() ? "nothing follows it" : next + " follows, which begins like a flag",
          .suggestion = fmt::format("write {} {}", name, option.value) +
                        (may_be_meant ? fmt::format(", or {}={} if that is meant", name, next) : "")};
}

// Nothing for words that begin with no command of the table.
std::optional<CommandTable> command_of(const CLI::App& app, std::span<const std::string> words) {
  if (words.empty()) return std::nullopt;
  ProgramTable program = program_table(app);
  const auto command = std::ranges::find(program.commands, words.front(), &CommandTable::name);
  return command == program.commands.end() ? std::nullopt : std::optional(std::move(*command));
}

}  // namespace

void refuse_flags_without_values(const CLI::App& app, std::span<const std::string> words) {
  const std::optional<CommandTable> command = command_of(app, words);
  if (!command) return;
  std::vector<Problem> problems;
  for (std::size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
    const std::string name = is_flag(words[i]) ? std::string(name_in(words[i])) : "";
    const OptionRow* option = name == words[i] ? option_named(*command, name) : nullptr;
    if (option == nullptr || option->value.empty() || takes_a_vector(*option)) continue;
    const std::string next = i + 1 < words.size() ? words[i + 1] : "";
    if (i + 1 < words.size() && !is_other_flag(*command, next)) {
      ++i;
    } else {
      problems.push_back(without_value(*command, *option, name, next));
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

void refuse_misused_flags(const CLI::App& app, std::span<const std::string> words) {
  const std::optional<CommandTable> command = command_of(app, words);
  if (!command) return;
  std::vector<Problem> problems;
  for (const GivenFlag& flag : given_flags(words.subspan(1))) {
    const OptionRow* option = option_named(*command, flag.name);
    if (option == nullptr) {
      problems.push_back(unknown(*command, flag));
    } else if (takes_a_vector(*option)) {
      if (auto problem = wrong_count(*option, flag)) problems.push_back(std::move(*problem));
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace exactff::cli
