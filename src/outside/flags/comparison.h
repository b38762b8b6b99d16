// The flags of a comparison of methods on one scene: those of `exactff compare`, and of a scene line in a study file.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "exactff/error.h"
#include "exactff/study.h"
#include "flags/camera.h"
#include "flags/engine.h"
#include "flags/receivers.h"
#include "flags/scene.h"
#include "flags/sources.h"

namespace exactff::flags {

// The flags as given; empty if a flag was not given.
struct ComparisonArguments {
  flags::SceneArguments scene;
  flags::ReceiverArguments receivers;
  flags::SourceArguments sources;
  std::string eps_b, eps_a, rays, seeds, pattern, variant;
  std::vector<std::string> methods;
  bool no_methods = false;
  bool sweep = false;
  std::string method_seeds, method_receivers, method_budget, sweep_budget;
  flags::EngineArgument engine;
  flags::CameraArguments camera;  // of the report's pictures
  std::string title;
  bool unless_abridged = false;

  void add_to(CLI::App& app);
};

struct Comparison {
  std::string title;
  std::shared_ptr<const Scene> scene;
  study::Request request;
  std::vector<Problem> warnings;  // of its receivers
};

// Loads the scene and completes the request. `abridged` makes grids coarser, and reduces the settings that are not
// given. Throws InputError.
[[nodiscard]] Comparison comparison_of(ComparisonArguments args, bool abridged, int threads);

// "cornell_box.obj" for a path, "teapot:segments=8" for a model.
[[nodiscard]] std::string short_name(const std::string& scene);

// The flags again, each preceded by a blank and quoted for a shell. SCENE is not among them.
[[nodiscard]] std::string command_words(const ComparisonArguments& args);

}  // namespace exactff::flags
