#include "cli/option_table.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "exactff/methods.h"
#include "exactff/models.h"
#include "report/plan.h"
#include "stress/stress.h"
#include "text/nearest_names.h"

namespace exactff::cli {
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

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
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
  return " (" + range.substr(0, dash) + " to " + range.substr(dash + 3) + ")";
}

std::string description_of(const CLI::Option& option, const TypeText& type) {
  std::string text = option.get_description() + range_note(type.check);
  if (!option.get_default_str().empty()) text += " (default: " + option.get_default_str() + ")";
  for (const CLI::Option* other : option.get_excludes()) text += " (not with " + other->get_name() + ")";
  for (const CLI::Option* other : option.get_needs()) text += " (only with " + other->get_name() + ")";
  return text;
}

std::string ellipsis(const OptionRow& row) { return row.most_values == kManyValues ? "..." : ""; }

// What completion offers for a placeholder of an option or the name of a positional argument: EXPERIMENT, FAMILY,
// METHOD, or SCENE (the generated ones, with their @).
std::vector<std::string> known_words(const std::string& kind) {
  std::vector<std::string> words;
  if (kind == "METHOD") {
    for (const methods::Method* method : methods::all_methods()) words.push_back(method->name);
  } else if (kind == "SCENE") {
    for (const models::Model* model : models::all_models()) words.push_back('@' + std::string(model->name));
  } else if (kind == "FAMILY") {
    for (const stress::FamilyInfo& family : stress::families()) words.emplace_back(family.name);
  } else if (kind == "EXPERIMENT") {
    words = report::experiment_names();
    words.emplace_back("all");
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
  CommandTable table{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
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

  row.choices = split(between(type.check, "{", '}'), ',');
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
  std::vector<std::string> names;
  for (const CommandTable& command : table.commands) names.push_back(command.name);
  for (CommandTable& command : table.commands) {
    for (OptionRow& row : command.positionals) {
      if (row.value != "COMMAND") continue;
      row.words = names;
      row.completion = Completion::kWords;
    }
  }
  return table;
}

}  // namespace exactff::cli
