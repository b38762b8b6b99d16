#include "cli/scene_options.h"

#include <algorithm>
#include <iostream>

#include "exactff/models.h"
#include "exactff/obj.h"
#include "scene/text_lines.h"

namespace exactff::cli {

void print_warnings(std::span<const Problem> warnings) {
  constexpr std::size_t kPrinted = 20;
  for (const Problem& warning : warnings.first(std::min(warnings.size(), kPrinted))) {
    std::cerr << "warning: " << warning.message() << '\n';
  }
  const bool at_least = warnings.size() > ProblemList::kKept;
  if (warnings.size() > kPrinted) {
    std::cerr << "warning: ... and " << (at_least ? "more than " : "") << warnings.size() - kPrinted << " more\n";
  }
}

void SceneArguments::add_to(CLI::App& app) {
  app.add_option("SCENE", path,
                 "Wavefront OBJ file, or @MODEL[:SETTING=VALUE,...] for a generated scene: `exactff info @` lists them")
      ->required();
  app.add_option("--patches", patches, "What makes a patch: groups (g, else o) or faces (each face NAME:k)")
      ->check(CLI::IsMember({"groups", "faces"}))
      ->capture_default_str();
  app.add_flag("--skip-bad-faces", skip_bad_faces, "Leave unusable faces out, with a warning, instead of stopping");
}

SceneOptions SceneArguments::options() const {
  return {skip_bad_faces ? BadFaces::kSkip : BadFaces::kReject,
          patches == "faces" ? PatchMode::kFaces : PatchMode::kGroups};
}

Scene SceneArguments::load() const {
  Scene scene = path.starts_with('@') ? models::make_scene(path.substr(1), options()) : read_obj(path, options());
  print_warnings(scene.warnings());
  return scene;
}

}  // namespace exactff::cli
