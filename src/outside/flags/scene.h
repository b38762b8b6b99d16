// Flags that many commands share: the scene, its radiosities, a camera, the engine.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "exactff/radiosity.h"
#include "exactff/render.h"
#include "exactff/scene.h"
#include "flags/values.h"

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

// The flag --radiosity.
struct SolutionArgument {
  std::string file;  // empty: not given

  void add_to(CLI::App& app);
  [[nodiscard]] bool is_given() const { return !file.empty(); }
};

struct LitScene {
  Scene scene;
  std::optional<radiosity::Radiosities> radiosities;
};

// Loads the scene. If a solution is given, divides it and makes its faces two-sided as the file says, and takes the
// radiosities. Throws InputError if they are of another scene, or if --divide has another length.
[[nodiscard]] LitScene load(const SceneArguments& scene, const SolutionArgument& solution);

struct CameraArguments {
  ThreeNumbers eye, look, up;
  std::optional<double> fov;

  void add_to(CLI::App& app, const std::string& eye_meaning, const std::string& look_meaning);
  // Whether --eye and --look are given. Throws InputError if only one of them is.
  [[nodiscard]] bool is_placed() const;
  // Requires both. Without --up, render::upwards(scene) points upwards or, in a view along it, the other axis.
  [[nodiscard]] render::Camera camera(const Scene& scene) const;
  [[nodiscard]] render::CameraWishes wishes() const;
};

// What is integrated over what is seen.
struct MeasureArgument {
  std::string name = "form-factor";

  void add_to(CLI::App& app);
  // `up`: of --up.
  [[nodiscard]] Measure measure(const ThreeNumbers& up, bool sphere = false) const;
};
// "form factor", "solid angle in sr", ...
[[nodiscard]] std::string words_of(const Measure& measure);

struct EngineArgument {
  std::string name = "edges";

  void add_to(CLI::App& app) {
    app.add_option("--engine", name,
                   "How the visible region is found: edges (fast), boolean (Boolean set operations, the reference) or "
                   "both (run both and compare); it does not affect the values")
        ->capture_default_str()
        ->check(CLI::IsMember({"edges", "boolean", "both"}));
  }
  [[nodiscard]] Engine engine() const {
    return name == "both" ? Engine::kBoth : name == "boolean" ? Engine::kBoolean : Engine::kEdges;
  }
};

}  // namespace exactff::flags
