// The flags of every command that reads a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "exactff/scene.h"

namespace exactff::flags {

inline constexpr const char* kStandardInput = "standard input";  // what messages call it

// SCENE, --patches groups|faces, --skip-bad-faces. SCENE is a file, "-" for an OBJ
// file on standard input, or @MODEL[:SETTING=VALUE,...] (exactff/models.h). A
// name that begins with @ always means a model; write ./@NAME for a file of that name.
struct SceneArguments {
  std::string path;
  std::string patches = "groups";
  bool skip_bad_faces = false;

  void add_to(CLI::App& app);
  [[nodiscard]] bool from_standard_input() const { return path == "-"; }

  [[nodiscard]] SceneOptions options() const;
  // Reads or generates the scene. Throws InputError.
  [[nodiscard]] Scene load() const;
};

}  // namespace exactff::flags
