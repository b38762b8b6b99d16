// What a Scene promises to whoever reads it from a file, and the file that gives it back.
#pragma once

#include <string>

#include "exactff/scene.h"

namespace exactff::validation {

// What is wrong, in a few words; nothing if all promises hold: indices in range, pieces convex, planar, not empty
// and together their face, names that select what they name.
[[nodiscard]] std::string broken_promise(const Scene& scene);

// Reading the texts gives a scene with the same hash. `mtl_name` is what the OBJ text calls the other.
struct SceneText {
  std::string obj;
  std::string mtl;
};
[[nodiscard]] SceneText text_of(const Scene& scene, const std::string& mtl_name);

}  // namespace exactff::validation
