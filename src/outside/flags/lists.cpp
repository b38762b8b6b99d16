#include "flags/lists.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "scene/selections.h"
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

}  // namespace exactff::flags
