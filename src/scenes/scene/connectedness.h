// How far the pieces of a scene are connected, and what a search for silhouettes (edges.h) may therefore save.
#pragma once

#include "exactff/scene.h"

namespace exactff {

// About how many edges there are for each that is a silhouette from a typical point. Of a soup of faces 1, of a box
// less than 3, of a mesh of n triangles about sqrt(n) / 3. Found at the first call, in about linear time; safe to call
// from several threads.
[[nodiscard]] double edges_per_silhouette(const Scene& scene);

}  // namespace exactff
