// The flags that every command which reads a scene has.
#pragma once

#include <string>

#include "cli/command.h"
#include "exactff/scene.h"

namespace exactff::cli {

// Writes "warning: ..." to stderr for each, the first 20 and a count of the others.
void print_warnings(std::span<const Problem> warnings);

// SCENE, --patches groups|faces, --skip-bad-faces. SCENE is a file, or @MODEL[:SETTING=VALUE,...] (exactff/models.h),
// whatever files there are: one of that name is reached as ./@NAME.
struct SceneArguments {
  std::string path;
  std::string patches = "groups";
  bool skip_bad_faces = false;

  void add_to(CLI::App& app);

  [[nodiscard]] SceneOptions options() const;
  // Reads or makes the scene; its warnings go to stderr. Throws InputError.
  [[nodiscard]] Scene load() const;
};

}  // namespace exactff::cli
