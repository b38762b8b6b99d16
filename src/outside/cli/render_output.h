// What exactff render writes and prints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exactff/render.h"

namespace exactff::cli {

struct Rendered {
  render::Picture picture = {};
  std::optional<render::Picture> judged = {};  // by the method of --against, or its file
  std::string judged_name = {};
  std::optional<render::Errors> errors = {};
};

// Throws InputError if a file cannot be written. Empty names are left out.
void check_files(const std::vector<std::string>& images, const std::vector<std::string>& arrays);

struct RenderFiles {
  std::string image, doubles, bounds;
  std::optional<double> exposure;
  bool strip = false;
};
void write_files(const RenderFiles& files, const Rendered& rendered);

// The summary on standard output. `tell_camera`: the camera was chosen by the program.
void print_rendered(const Rendered& rendered, const RenderFiles& files, const std::string& camera);

// Returns the exit code: 3, with a message, if a value is not certified.
[[nodiscard]] int warn_of_uncertified_points(const Rendered& rendered);

}  // namespace exactff::cli
