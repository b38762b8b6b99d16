#include "flags/scene.h"

#include <iostream>

#include "exactff/models.h"
#include "exactff/obj.h"

namespace exactff::flags {

void SceneArguments::add_to(CLI::App& app) {
  app.add_option("SCENE", path,
                 "Wavefront OBJ file, - for standard input, or @MODEL[:SETTING=VALUE,...] for a generated scene: "
                 "`exactff info @` lists them")
      ->required();
  app.add_option("--patches", patches,
                 "What a patch is: groups (g lines; without them, o lines) or faces (each face is a patch NAME:k)")
      ->check(CLI::IsMember({"groups", "faces"}))
      ->capture_default_str();
  app.add_flag("--skip-bad-faces", skip_bad_faces, "Leave out unusable faces with a warning instead of stopping");
}

SceneOptions SceneArguments::options() const {
  return {skip_bad_faces ? BadFaces::kSkip : BadFaces::kReject,
          patches == "faces" ? PatchMode::kFaces : PatchMode::kGroups};
}

Scene SceneArguments::load() const {
  if (from_standard_input()) return read_obj(std::cin, kStandardInput, options());
  return path.starts_with('@') ? models::make_scene(path.substr(1), options()) : read_obj(path, options());
}

}  // namespace exactff::flags
