// What a Scene read from a file promises to its users, and the text that reads back to the same scene.
#pragma once

#include <string>

#include "exactff/scene.h"

namespace exactff::validation {

// A short description of a broken promise; empty if all promises hold: indices are in range; pieces are convex, planar,
// not empty and together form their face; names select what they name.
[[nodiscard]] std::string broken_promise(const Scene& scene);

// Texts that read back to a scene with the same hash. `mtl_name` is the name of the material file in the OBJ text.
struct SceneText {
  std::string obj;
  std::string mtl;
};
[[nodiscard]] SceneText text_of(const Scene& scene, const std::string& mtl_name);

}  // namespace exactff::validation
