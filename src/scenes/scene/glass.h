// Materials that let light through in the program that made the scene, but occlude here.
#pragma once

#include <vector>

#include "exactff/scene.h"

namespace exactff {

// One warning for each such material that is used by a face which is not transparent.
[[nodiscard]] std::vector<Problem> warnings_of_opaque_glass(const Scene& scene);

}  // namespace exactff
