// Scenes that the program makes itself, so that a study of ten thousand triangles needs no file.
//
// A scene is named by a model and its settings, in the way in which methods are (methods.h):
//
//   const Scene scene = models::make_scene("karkanis:n=200,seed=3");
//
// The same text gives the same bits on every machine: random numbers are the library's own, and coordinates come from
// + - * / and square roots alone, which IEEE 754 rounds in one way. Commands take @karkanis:n=200,seed=3 for a scene.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exactff/methods.h"
#include "exactff/scene.h"

namespace exactff::models {

struct PlainScene;  // the library's own

struct Model {
  std::string name;     // letters, digits and hyphens
  std::string summary;  // what it is of, and its patches
  std::vector<methods::SettingSpec> settings;
  PlainScene (*make)(const methods::Settings&) = nullptr;  // for the library
};

// In the order in which they are listed. Models stay where they are as long as the program runs.
[[nodiscard]] std::vector<const Model*> all_models();

// NAME or NAME:SETTING=VALUE,... with blanks anywhere between. Throws one InputError with everything that is wrong, and
// says what is allowed.
[[nodiscard]] Scene make_scene(std::string_view text, const SceneOptions& options = {});

// The same as a Wavefront file. `mtl` is the file that it names for its materials, and whose text make_mtl() gives: the
// two read back to a scene of the same hash. Without a name there are no materials, and nothing emits. Comments state
// the text that makes it again, in full, and a receiver and a source to begin with.
[[nodiscard]] std::string make_obj(std::string_view text, const std::string& mtl = {});
[[nodiscard]] std::string make_mtl(std::string_view text);

// Name, summary and every setting with its meaning, default and range, a setting a line.
[[nodiscard]] std::string description(const Model& model);

}  // namespace exactff::models
