// The flags of a camera, shared by `exactff render` and `exactff compare`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "exactff/render.h"
#include "flags/vector.h"

namespace exactff::flags {

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

// The flags again, each preceded by a blank.
[[nodiscard]] std::string command_words(const CameraArguments& args);

}  // namespace exactff::flags
