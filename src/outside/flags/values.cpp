#include "flags/values.h"

#include <algorithm>

#include "scene/selections.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/number_text.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::flags {
namespace {

// Whether the text with its commas is one name. A pattern is not: its parts are.
bool is_a_name(const Scene& scene, const std::string& text) {
  try {
    (void)(Scene::is_pattern(text) ? std::vector{scene.select(text)} : scene.select_all(text));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool means_all(const Scene& scene, const std::string& name) { return name == "all" && !has_patch(scene, name); }

void add(const Scene& scene, const std::string& name, std::vector<Selection>& selections) {
  if (means_all(scene, name)) {
    const std::vector<Selection> all = all_patches(scene);
    selections.insert(selections.end(), all.begin(), all.end());
    return;
  }
  for (const Selection& part : scene.select_all(name)) {
    if (Scene::is_pattern(name) && std::ranges::find(selections, part) != selections.end()) continue;
    selections.push_back(part);
  }
}

// As other programs call it.
void refuse_other_names_of_sky(const Scene& scene, const std::string& name) {
  constexpr std::array<std::string_view, 17> kOthers = {
      "sky",  "space",  "void",    "outside", "outdoor",  "outdoors",     "environment", "env",     "ambient",
      "open", "(open)", "nothing", "air",     "exterior", "surroundings", "background",  "infinity"};
  if (name == "sky" || has_patch(scene, name) || is_a_name(scene, name)) return;
  if (std::ranges::find(kOthers, text::in_lower_case(name)) == kOthers.end()) return;
  text::refuse("there is no patch named " + text::in_quotes(name, text::kShownName),
               "what is open, all directions that meet nothing, is called sky here", "write sky instead");
}

// If numbers are missing, the flag that follows would be read as one of them.
std::string is_no_flag(const std::string& text) {
  return text.starts_with("--") ? "needs three numbers; found '" + text + "' among them" : "";
}

double finite_number(const std::string& text, const std::string& flag) {
  const text::ParsedNumber number = text::parse_number(text);
  if (number.fault == text::NumberFault::kNone) return number.value;
  text::refuse(flag + ": " + describe(number.fault, text), "a coordinate is a finite decimal number",
               "give three numbers, for example " + flag + " 0 0.5 -1e-3");
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

std::string is_positive(const std::string& text) {
  const text::ParsedNumber number = text::parse_number(text);
  return number.fault == text::NumberFault::kNone && number.value > 0.0 ? ""
                                                                        : "'" + text + "' is not a positive number";
}

std::vector<Selection> selections_named(const Scene& scene, const std::vector<std::string>& texts) {
  std::vector<Selection> selections;
  for (const std::string& text : texts) {
    const std::vector<std::string> parts = split_list(text);
    const bool is_one_name = parts.size() > 1 && is_a_name(scene, text);
    for (const std::string& name : is_one_name ? std::vector{text} : parts) add(scene, name, selections);
  }
  return selections;
}

bool take_sky(const Scene& scene, std::vector<std::string>& texts) {
  std::vector<std::string> kept;
  bool found = false;
  for (const std::string& text : texts) {
    for (const std::string& name : has_patch(scene, text) ? std::vector{text} : split_list(text)) {
      refuse_other_names_of_sky(scene, name);
      const bool is_sky = name == "sky" && !has_patch(scene, name);
      found = found || is_sky;
      if (!is_sky) kept.push_back(name);
    }
  }
  if (found) texts = kept;
  return found;
}

bool names_all(const Scene& scene, const std::vector<std::string>& texts) {
  return std::ranges::any_of(texts, [&](const std::string& text) {
    const std::vector<std::string> parts = split_list(text);
    if (parts.size() > 1 && is_a_name(scene, text)) return false;
    return std::ranges::any_of(parts, [&](const std::string& part) { return means_all(scene, part); });
  });
}

void add_names(CLI::App& app, const std::string& flag, std::vector<std::string>& names, const std::string& meaning,
               const std::string& more) {
  app.add_option(flag, names, meaning + kNamesHelp + more)
      ->type_name("NAME[:K]")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_threads(CLI::App& app, int& threads) {
  app.add_option("--threads", threads, "Number of threads (default: all); it does not affect the values")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
}

std::string command_words(const CLI::App& command, const std::vector<std::string>& left_out) {
  std::string line;
  for (const CLI::Option* option : command.get_options()) {
    const std::string flag = option->get_name();
    if (option->count() == 0 || option->get_positional() || std::ranges::count(left_out, flag) > 0) continue;
    const bool is_switch = option->get_items_expected_max() == 0, takes_several = option->get_type_size() > 1;
    if (is_switch || takes_several) line += ' ' + flag;
    if (is_switch) continue;
    for (const std::string& value : option->results()) {
      line += (takes_several ? "" : ' ' + flag) + ' ' + text::shell_word(value);
    }
  }
  return line;
}

CLI::Option* add_vector_option(CLI::App& app, const std::string& flag, ThreeNumbers& numbers,
                               const std::string& meaning, const std::string& type) {
  return app.add_option(flag, numbers, meaning)->type_name(type)->check(is_no_flag);
}

Vec3 vector_of(const ThreeNumbers& numbers, const std::string& flag) {
  return {finite_number(numbers[0], flag), finite_number(numbers[1], flag), finite_number(numbers[2], flag)};
}

}  // namespace exactff::flags
