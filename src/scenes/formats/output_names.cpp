#include "formats/output_names.h"

#include <string_view>
#include <unordered_set>

#include "formats/mesh_input.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::formats {

std::string fit_name(std::string name, const NameRules& rules) {
  constexpr std::string_view kNever("\0\r\n", 3);
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; };
  if (name.empty()) return "_";
  for (std::size_t i = 0; i < name.size(); ++i) {
    char& c = name[i];
    const bool at_end = i == 0 || i + 1 == name.size();
    const bool begins_word = i == 0 || is_blank(name[i - 1]);
    if (kNever.find(c) != std::string_view::npos || (is_blank(c) && (rules.one_word || at_end)) ||
        (rules.comment != '\0' && c == rules.comment && (begins_word || !rules.only_before_word)) ||
        (rules.joins_lines && c == '\\' && i + 1 == name.size())) {
      c = '_';
    }
  }
  return name;
}

// Names that need no change go first, so that they keep theirs.
std::vector<std::string> output_names(std::vector<std::string> names, const NameRules& rules, const std::string& noun,
                                      Losses& losses) {
  std::unordered_set<std::string> taken;
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (fit_name(names[i], rules) != names[i] || !taken.insert(names[i]).second) changed.push_back(i);
  }
  if (changed.empty()) return names;
  const std::string before = names[changed.front()];
  for (const std::size_t i : changed) {
    names[i] = fit_name(names[i], rules);
    while (!taken.insert(names[i]).second) names[i] += "_" + std::to_string(i + 1);
  }
  losses.add("the " + noun + " " + text::in_quotes(before) + " is called " + text::in_quotes(names[changed.front()]) +
                 (changed.size() > 1 ? ", and " + text::counted(changed.size() - 1, "other") + " change as well" : ""),
             "the format cannot hold the name", "rename it if this matters");
  return names;
}

std::vector<std::string> patch_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Patch& patch : scene.patches()) names.push_back(patch.name);
  return names;
}

bool has_only_default_patch(const Scene& scene) {
  const auto patches = scene.patches();
  return patches.empty() || (patches.size() == 1 && patches.front().name == kDefaultPatch);
}

}  // namespace exactff::formats
