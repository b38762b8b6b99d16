// The flag --radiosity, and the scene that its file belongs to.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "exactff/radiosity.h"
#include "exactff/scene.h"
#include "flags/scene.h"

namespace exactff::flags {

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

}  // namespace exactff::flags
