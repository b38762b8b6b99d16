#include "flags/lists.h"

#include <algorithm>

#include "text/number_text.h"

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

void add_all(const Scene& scene, std::vector<Selection>& selections) {
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection whole{PatchId(static_cast<std::uint32_t>(p)), {}};
    if (!scene.faces_of(whole).empty()) selections.push_back(whole);
  }
}

bool means_all(const Scene& scene, const std::string& name) {
  return name == "all" && std::ranges::none_of(scene.patches(), [&](const Patch& p) { return p.name == name; });
}

void add(const Scene& scene, const std::string& name, std::vector<Selection>& selections) {
  if (means_all(scene, name)) return add_all(scene, selections);
  for (const Selection& part : scene.select_all(name)) {
    if (Scene::is_pattern(name) && std::ranges::find(selections, part) != selections.end()) continue;
    selections.push_back(part);
  }
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
  const auto is_patch = [&](const std::string& name) {
    return std::ranges::any_of(scene.patches(), [&](const Patch& patch) { return patch.name == name; });
  };
  std::vector<std::string> kept;
  bool found = false;
  for (const std::string& text : texts) {
    for (const std::string& name : is_patch(text) ? std::vector{text} : split_list(text)) {
      const bool is_sky = name == "sky" && !is_patch(name);
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
