// Convex pieces in one plane, compared exactly.
#pragma once

#include "exactff/scene.h"

namespace exactff {

// Whether the pieces have more than an edge or a point in common. Requires that they lie in one plane.
[[nodiscard]] bool overlap(const Scene& scene, const Piece& a, const Piece& b);

// Whether their fronts look the same way. The same requirement.
[[nodiscard]] bool have_same_front(const Scene& scene, const Piece& a, const Piece& b);

// Whether they have the same corners: then they cover the same points.
[[nodiscard]] bool have_same_corners(const Scene& scene, const Piece& a, const Piece& b);

}  // namespace exactff
