#include "text/choice_text.h"

#include <algorithm>

#include "text/nearest_names.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::text {

namespace {

// The part before `mark`, which is removed from `rest` together with the mark; the whole rest if there is no mark.
std::string_view take_until(std::string_view& rest, char mark) {
  const std::size_t end = std::min(rest.find(mark), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return trimmed(part);
}

// Reads one SETTING=VALUE.
void read_assignment(std::string_view text, Settings& settings, std::vector<std::string>& seen) {
  std::string_view value = text;
  const std::string name(take_until(value, '='));
  if (text.find('=') == std::string_view::npos) {
    refuse("'" + std::string(text) + "' has no value", "settings are written NAME=VALUE", {});
  }
  if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
    refuse("setting '" + name + "' is given twice", "a setting has one value", "remove one");
  }
  seen.push_back(name);
  settings.set_text(name, trimmed(value));
}

}  // namespace

ChoiceText take_apart(std::string_view text) {
  const std::string_view name = take_until(text, ':');
  return {name, text};
}

void read_assignments(std::string_view assignments, const std::string& whose, Settings& settings) {
  std::vector<Problem> problems;
  std::vector<std::string> seen;
  while (!trimmed(assignments).empty()) {
    try {
      read_assignment(take_until(assignments, ','), settings, seen);
    } catch (const InputError& error) {
      for (Problem problem : error.problems()) {
        problem.what = whose + ": " + problem.what;
        problems.push_back(std::move(problem));
      }
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

InputError unknown_name(const std::string& kind, std::string_view name, const std::vector<std::string_view>& known) {
  return InputError(Problem{{},
                            0,
                            "there is no " + kind + " '" + std::string(name) + "'",
                            kind + "s are " + joined(known),
                            "did you mean " + joined(nearest_names(known, name, 3)) + "?"});
}

std::string setting_lines(std::span<const SettingSpec> settings) {
  std::string text;
  for (const SettingSpec& spec : settings) {
    text += "  " + spec.name + "=" + to_string(spec.fallback) + (spec.unit.empty() ? "" : " " + spec.unit) + ": " +
            spec.meaning + "; " + allowed(spec) + "\n";
  }
  return text;
}

}  // namespace exactff::text
