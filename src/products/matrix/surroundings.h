// What patches see besides fronts, as patches of scenes that are made for this question. In these scenes, the ids of
// all patches and faces of the given scene are the same, and what was added is transparent.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "exactff/scene.h"

namespace exactff::matrix {

// All columns are patches of turned copies of faces, and of copies of fronts in the planes of `overlaps`. The factor to
// the backs is the sum of those to `whole`, plus, for each of `overlaps`, that to `both` minus that to `fronts`; the
// difference is 0 for a patch that sees nothing of `turned`.
struct SceneWithBacks {
  // Planes in which backs and fronts overlap in part: the union of both, the fronts, and the backs.
  struct Overlap {
    Selection turned, both, fronts;
  };

  Scene scene;
  std::vector<Selection> whole;  // the backs of closed surfaces, which hide them from most, and the others
  std::vector<Overlap> overlaps;
};
[[nodiscard]] SceneWithBacks with_backs(const Scene& scene);

// All that hides anything, from either side, as patches of copies of fronts and of turned copies. What overlaps in a
// plane counts once.
struct SceneWithSides {
  Scene scene;
  std::optional<Selection> all;  // nothing if all faces are transparent
  // If there are closed surfaces: their backs, which they hide from most, and all other sides.
  std::optional<Selection> closed_backs, others;
};
[[nodiscard]] SceneWithSides with_sides(const Scene& scene);

// Within a surface with a hole in a plane, with nothing of the scene beyond the plane, what is open is what is seen of
// the hole.
struct SceneWithSky {
  // A convex hole, filled by a face that looks at the surface.
  struct Window {
    std::size_t surface;  // an index of ClosedSurfaces::surfaces(), with edges cut at T-junctions
    Selection patch;
  };

  Scene scene;
  Selection sky;  // a cube around everything; its fronts look inward
  std::vector<Window> windows;
};
// Throws InputError if the scene is so large that there is no double to put a corner at.
[[nodiscard]] SceneWithSky with_sky(const Scene& scene);

// The same patches of a scene with more faces.
[[nodiscard]] std::vector<Selection> of_any_scene(std::span<const Selection> patches);

// What is proved of patches without a factor: that no point of one sees a back, or anything open. False does not mean
// that it does.
struct ProvedZeros {
  std::vector<bool> back, open;  // for each of the patches
};
[[nodiscard]] ProvedZeros proved_zeros(const Scene& scene, std::span<const Selection> from);

// Whether fronts of different patches overlap in one plane.
[[nodiscard]] bool have_fronts_in_common(const Scene& scene);

}  // namespace exactff::matrix
