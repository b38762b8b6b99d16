// The flags of every command that reads a scene.
#pragma once

#include <string>

#include "cli/command.h"
#include "exactff/scene.h"

namespace exactff::cli {

// Writes "warning: ..." to stderr for the first 20 warnings, then the number of the others.
void print_warnings(std::span<const Problem> warnings);

// SCENE, --patches groups|faces, --skip-bad-faces. SCENE is a file, or @MODEL[:SETTING=VALUE,...] (exactff/models.h). A
// name that begins with @ always means a model; write ./@NAME for a file of that name.
struct SceneArguments {
  std::string path;
  std::string patches = "groups";
  bool skip_bad_faces = false;

  void add_to(CLI::App& app);

  [[nodiscard]] SceneOptions options() const;
  // Reads or generates the scene. Its warnings go to stderr. Throws InputError.
  [[nodiscard]] Scene load() const;
};

}  // namespace exactff::cli
