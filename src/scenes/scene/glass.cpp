#include "scene/glass.h"

#include "scene/selections.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff {

namespace {

constexpr std::size_t kMostWarnings = 20;

Problem warning(const Scene& scene, const Material& material, const std::vector<FaceId>& faces) {
  const std::vector<Selection> users = selections_of(scene, faces);
  const std::string flag = flag_words(scene, "--transparent", users);
  return {material.file, material.line,
          "material " + text::in_quotes(material.name, text::kShownName) + " lets light through (" +
              material.see_through + "), but " + listed(scene, users) + (users.size() == 1 ? " occludes" : " occlude"),
          "every material is treated as opaque",
          "if it does not hide what is behind it, give " +
              (flag.empty() ? "the patches of this material to --transparent" : flag)};
}

}  // namespace

std::vector<Problem> warnings_of_opaque_glass(const Scene& scene) {
  std::vector<std::vector<FaceId>> users(scene.materials().size());
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    const Face& face = scene.faces()[i];
    const bool occludes = face.piece_count > 0 && !face.transparent;
    if (occludes && !scene.material(face.material).see_through.empty())
      users[index_of(face.material)].push_back(static_cast<FaceId>(i));
  }
  std::vector<Problem> warnings;
  std::size_t others = 0;
  for (std::size_t m = 0; m < users.size(); ++m) {
    if (users[m].empty()) continue;
    if (warnings.size() == kMostWarnings) {
      ++others;
    } else {
      warnings.push_back(warning(scene, scene.materials()[m], users[m]));
    }
  }
  if (others > 0)
    warnings.push_back({.what = text::counted(others, "more material") + " let light through, but occlude"});
  return warnings;
}

}  // namespace exactff
