#include "scene/selections.h"

#include <algorithm>

#include "text/escape.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff {

bool emits(const Scene& scene, const Selection& selection) {
  const std::vector<FaceId> faces = scene.faces_of(selection);
  return std::ranges::any_of(faces, [&](FaceId id) { return scene.material(scene.face(id).material).emits(); });
}

bool has_patch(const Scene& scene, std::string_view name) {
  return std::ranges::any_of(scene.patches(), [&](const Patch& patch) { return patch.name == name; });
}

std::vector<std::string> names_of(const Scene& scene, std::span<const Selection> selections) {
  std::vector<std::string> names;
  for (const Selection& selection : selections) names.push_back(scene.name_of(selection));
  return names;
}

std::vector<Selection> all_patches(const Scene& scene) {
  std::vector<Selection> patches;
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection patch{static_cast<PatchId>(p), {}, scene.id()};
    if (!scene.faces_of(patch).empty()) patches.push_back(patch);
  }
  return patches;
}

std::vector<Selection> selections_of(const Scene& scene, std::vector<FaceId> faces) {
  std::erase_if(faces, [&](FaceId id) { return scene.face(id).piece_count == 0; });
  const auto key = [&](FaceId id) { return std::pair(scene.face(id).patch, id); };
  std::ranges::sort(faces, {}, key);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::vector<Selection> selections;
  for (auto first = faces.begin(); first != faces.end();) {
    const Selection patch{scene.face(*first).patch, {}, scene.id()};
    const auto last = std::find_if(first, faces.end(), [&](FaceId id) { return scene.face(id).patch != patch.patch; });
    if (static_cast<std::size_t>(last - first) == scene.faces_of(patch).size()) {
      selections.push_back(patch);
    } else {
      for (auto face = first; face != last; ++face) selections.push_back(selection_of(scene, *face));
    }
    first = last;
  }
  return selections;
}

double area_of(const Scene& scene, const Selection& selection) {
  double area = 0.0;
  for (const FaceId face : scene.faces_of(selection)) area += scene.face(face).area;
  return area;
}

std::set<FaceId> faces_of(const Scene& scene, std::span<const Selection> selections) {
  std::set<FaceId> all;
  for (const Selection& selection : selections) {
    const std::vector<FaceId> faces = scene.faces_of(selection);
    all.insert(faces.begin(), faces.end());
  }
  return all;
}

std::string quoted(const Scene& scene, const Selection& selection) {
  return text::in_quotes(scene.name_of(selection), text::kShownName);
}

std::string flag_words(const Scene& scene, std::string_view flag, std::span<const Selection> selections) {
  constexpr std::size_t kMostTyped = 64;
  if (selections.empty() || selections.size() > kMostTyped) return {};
  std::string words, list;
  const auto add = [&](const std::string& value) {
    words += (words.empty() ? "" : " ") + std::string(flag) + ' ' + text::shell_word(value);
  };
  for (const Selection& selection : selections) {
    const std::string name = scene.name_of(selection);
    if (name.find(',') == std::string::npos) {
      list += (list.empty() ? "" : ",") + name;
    } else {
      add(name);
    }
  }
  if (!list.empty()) add(list);
  return words;
}

std::string listed(const Scene& scene, std::span<const Selection> selections) {
  constexpr std::size_t kShown = 6;
  std::vector<std::string> words = names_of(scene, selections.first(std::min(kShown, selections.size())));
  for (std::string& word : words) word = text::in_quotes(word, text::kShownName);
  if (selections.size() > kShown) words.push_back(std::to_string(selections.size() - kShown) + " more");
  return text::enumerate(words);
}

}  // namespace exactff
