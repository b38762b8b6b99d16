// What a Scene read from a file promises to its users.
#pragma once

#include <string>

#include "exactff/scene.h"

namespace exactff::validation {

// A short description of a broken promise; empty if all promises hold: indices are in range; pieces are convex, planar,
// not empty and together form their face; names select what they name.
[[nodiscard]] std::string broken_promise(const Scene& scene);

}  // namespace exactff::validation
