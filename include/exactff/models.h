// Generated scenes, so that a study of ten thousand triangles needs no file.
//
// A text names a model and its settings, as for methods (methods.h):
//
//   const Scene scene = models::make_scene("karkanis:n=200,seed=3");
//
// The same text gives the same bits on every machine: random numbers come from the library's own generator, and
// coordinates are computed with + - * / and square roots alone, which IEEE 754 rounds in only one way. Commands accept
// @karkanis:n=200,seed=3 as a scene.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"
#include "exactff/settings.h"

namespace exactff::models {

struct Model {
  std::string name;     // letters, digits and hyphens
  std::string summary;  // what it shows, and its patches
  std::vector<SettingSpec> settings;
};

// All models in the order of listing. The pointers stay valid as long as the program runs.
[[nodiscard]] std::vector<const Model*> all_models();

// Makes the scene of NAME or NAME:SETTING=VALUE,...; blanks are allowed anywhere between. Throws one InputError that
// lists all errors and the allowed values.
[[nodiscard]] Scene make_scene(std::string_view text, const SceneOptions& options = {});

// The same scene as a Wavefront file. `mtl` is the name of the material file that it refers to; make_mtl() gives the
// text of that file. The two files read back to a scene with the same hash. Without a name there are no materials, and
// nothing emits. Comments in the file state the full text that reproduces it, and a receiver and a source to start
// with.
[[nodiscard]] std::string make_obj(std::string_view text, const std::string& mtl = {});
[[nodiscard]] std::string make_mtl(std::string_view text);

// Name, summary and every setting with its meaning, default and range, one setting per line.
[[nodiscard]] std::string description(const Model& model);

}  // namespace exactff::models
