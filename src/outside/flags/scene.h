// Flags that many commands share: the scene, its radiosities, a camera, the engine.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactff/error.h"
#include "exactff/exact.h"
#include "exactff/exr.h"
#include "exactff/radiosity.h"
#include "exactff/receiver.h"
#include "exactff/render.h"
#include "exactff/scene.h"
#include "flags/values.h"

namespace exactff::flags {

inline constexpr const char* kStandardInput = "standard input";  // what messages call it

// SCENE, --patches, --name, --names, --skip-bad-faces, --flip, --transparent. SCENE is a file, "-" for an OBJ file on
// standard input, or @MODEL[:SETTING=VALUE,...] (exactff/models.h). A name that begins with @ always means a model;
// write ./@NAME for a file of that name.
struct SceneArguments {
  std::string path;
  std::string unit;
  std::string patches = "groups";
  std::vector<std::string> names;  // NAME=SELECTOR
  std::string names_file;
  bool skip_bad_faces = false;
  std::vector<std::string> flip, transparent;  // each a name, a comma list of names, or "all"
  std::optional<double> divide;                // of commands with add_divide_to()
  const CLI::App* command = nullptr;           // of add_to(); none of its outputs may replace a file of the scene

  void add_to(CLI::App& app);
  void add_divide_to(CLI::App& app);  // --divide LENGTH
  [[nodiscard]] bool from_standard_input() const { return path == "-"; }
  [[nodiscard]] std::string file_name() const {  // without its folder
    return from_standard_input() ? kStandardInput : std::filesystem::path(path).filename().string();
  }

  [[nodiscard]] SceneOptions options() const;
  // Reads or generates the scene, names faces, changes it as --flip and --transparent say, and divides it, with a note
  // on standard error. Throws InputError, also if an output of the command would replace a file that the scene was read
  // from.
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

// How precise values of one receiver are.
struct PrecisionArguments {
  static constexpr int kMostDigits = 10000;
  int digits = 0;  // 0: the nearest double
  int cap = ExactOptions{}.precision_cap;

  void add_to(CLI::App& app);  // --digits, --precision-cap
};

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

// --- Receivers ---

// The flags of all commands over many receivers. Receivers: --receivers FILE, or --on NAME with one of --grid,
// --vertices,
// --centres, --samples. With --receivers, --on auto finds the faces. FILE may be an image that holds visible points.
// Sources: --source.

// The flags as given; empty if a flag was not given.
struct ReceiverArguments {
  std::vector<std::string> on;
  std::string grid;
  bool vertices = false;
  bool centres = false;
  bool per_face = false;
  std::string samples;
  std::string sample_seed;
  std::string file;
  exr::GBufferLayers layers;  // of a file that is an image
};

struct ChosenReceivers {
  std::vector<Receiver> receivers;
  std::string description;               // "floor, grid 32x32", "floor, 1000 samples, seed 1", "points.csv"
  std::size_t without_face = 0;          // that --on auto found no face for
  std::optional<exr::Frame> frame = {};  // if the receivers are pixels of an image
  std::vector<Problem> warnings = {};    // about the image
};

// Whether --receivers names an image, as its bytes or its name say.
[[nodiscard]] bool are_pixels(const ReceiverArguments& args);

// The distance of "auto" or "auto:DISTANCE". No distance: the default tolerance.
struct AutoFace {
  std::optional<double> tolerance;
};
// What --on says, unless it is the name of a patch. Throws InputError for a distance that is none.
std::optional<AutoFace> auto_face(const std::string& on, const Scene& scene);

// "--on auto found no face for 3 of 10 receivers; ...", and the warnings about an image.
std::vector<Problem> warnings_of_receivers(const ChosenReceivers& chosen);

void add_receiver_options(CLI::App& app, ReceiverArguments& args);

// Throws InputError if flags are missing or contradict each other. Needs no scene.
void check_receiver_options(const ReceiverArguments& args);

// Throws InputError if both are to be read from standard input.
void check_standard_input(const SceneArguments& scene, const ReceiverArguments& receivers);

// Checks the flags, too. Throws InputError, also if the named receivers are none.
ChosenReceivers receivers_of(const ReceiverArguments& args, const Scene& scene, GridIds grid_ids = GridIds::kUnique);

// --- sources ---

struct SourceArguments {
  std::vector<std::string> names;  // each a name, a comma list of names, or "all"
};

void add_source_options(CLI::App& app, SourceArguments& args);
void add_source_options_under_sky(CLI::App& app, SourceArguments& args);  // for sources_under_sky()

// In the given order. Empty if the flag was not given, which stands for every patch that emits. Throws InputError if a
// name is unknown or occurs twice, or is "sky".
std::vector<Selection> sources_of(const SourceArguments& args, const Scene& scene);

// The same for commands that know "sky", all directions that meet nothing, as a source. A patch of this name has
// priority.
struct SourcesUnderSky {
  std::vector<Selection> sources;  // empty, without sky: every patch that emits
  bool sky = false;
};
SourcesUnderSky sources_under_sky(const SourceArguments& args, const Scene& scene);

// A sentence that names those of the sources that emit nothing, and says how they count; empty if all emit.
std::string note_on_sources_without_emission(const Scene& scene, const std::vector<Selection>& sources);

}  // namespace exactff::flags
