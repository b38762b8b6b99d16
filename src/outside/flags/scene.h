// The flags of every command that reads a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff::flags {

inline constexpr const char* kStandardInput = "standard input";  // what messages call it

// SCENE, --patches groups|faces, --skip-bad-faces, --flip, --transparent. SCENE is a file, "-" for an OBJ file on
// standard input, or @MODEL[:SETTING=VALUE,...] (exactff/models.h). A name that begins with @ always means a model;
// write ./@NAME for a file of that name.
struct SceneArguments {
  std::string path;
  std::string patches = "groups";
  bool skip_bad_faces = false;
  std::vector<std::string> flip, transparent;  // each a name, a comma list of names, or "all"
  std::optional<double> divide;                // of commands with add_divide_to()
  const CLI::App* command = nullptr;           // of add_to(); none of its outputs may replace a file of the scene

  void add_to(CLI::App& app);
  void add_divide_to(CLI::App& app);  // --divide LENGTH
  [[nodiscard]] bool from_standard_input() const { return path == "-"; }

  [[nodiscard]] SceneOptions options() const;
  // Reads or generates the scene, changes it as --flip and --transparent say, and divides it, with a note on standard
  // error. Throws InputError, also if an output of the command would replace a file that the scene was read from.
  [[nodiscard]] Scene load() const;
};

// Prints the note on standard error.
[[nodiscard]] Scene divided_with_note(const Scene& scene, double length);

// The flags again, each preceded by a blank and quoted for a shell. SCENE is not among them.
[[nodiscard]] std::string command_words(const SceneArguments& args);

}  // namespace exactff::flags
