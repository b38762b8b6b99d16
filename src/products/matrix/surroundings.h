// What patches see besides fronts, as patches of scenes that are made for this question. In these scenes, the ids of
// all patches and faces of the given scene are the same, and what was added is transparent.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exactff/scene.h"

namespace exactff::matrix {

// The factor to the backs is the factor to `backs`, plus that to `both`, minus that to `fronts`. `both` is the union of
// the backs and fronts of the planes in which they overlap in part, `fronts` the fronts among them.
struct SceneWithBacks {
  Scene scene;
  std::optional<Selection> backs, both, fronts;
};
[[nodiscard]] SceneWithBacks with_backs(const Scene& scene);

struct SceneWithSky {
  Scene scene;
  Selection sky;  // a cube around everything; its fronts look inward
};
// Throws InputError if the scene is so large that there is no double to put a corner at.
[[nodiscard]] SceneWithSky with_sky(const Scene& scene);

// What is proved of patches without a factor: that no point of one sees a back, or anything open. False does not mean
// that it does.
struct ProvedZeros {
  std::vector<bool> back, open;  // for each of the patches
};
[[nodiscard]] ProvedZeros proved_zeros(const Scene& scene, std::span<const Selection> from);

// Whether fronts of different patches overlap in one plane.
[[nodiscard]] bool have_fronts_in_common(const Scene& scene);

}  // namespace exactff::matrix
