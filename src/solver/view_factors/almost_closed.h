// Surfaces that would be closed, had their corners not been moved a little: rooms as they are exported.
//
// Let pieces run along their sides from corner to corner, and let every corner p have an end w(p), the same for corners
// that are near each other. Beside each side p q of a piece lies a strip: triangles with the boundary p q, w(q), w(p),
// or, at a T-junction, p q, w(q), w(r), w(p), for corners r near the side. If the ways from end to end cancel, as many
// running one way as the other, then the pieces and their strips are a closed surface: no corner has to be moved, and
// no face to be bent. So w of scene/closed_surfaces.h tells, for a point off them, whether almost every ray from there
// meets a piece or a strip.
//
// What is open. Let the winding number just above all points of a set A of patches be other than 0. A ray from A that
// meets no piece meets a strip. Of the segments from A to a side of a strip that nothing hides, each direction at a
// point of the strip has one at most: by reciprocity, the integral over A of the point factor to this side is at most
// the strip's area. So the integral of what is open is at most the sum of the areas of both sides of all strips. In a
// row of patches that are not known to be in A all over, the rest of their area counts as open.
#pragma once

#include <vector>

#include "view_factors/exact_scene.h"

namespace exactff::view_factors {

struct AlmostClosedSurface {
  ExactSurface surface;            // its pieces, without its strips
  std::vector<ExactPiece> strips;  // triangles
  double area_of_strips = 0.0;     // or more, of both sides, in squares of the unit of Point::at
  double moved = 0.0;              // or more: how far a point of a strip is from its side
};

// Those that close with the least distances first: each has a piece that no earlier one has. Transparent pieces belong
// to none.
[[nodiscard]] std::vector<AlmostClosedSurface> almost_closed_surfaces(const ExactScene& scene);

}  // namespace exactff::view_factors
