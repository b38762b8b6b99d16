// The arcs of the visible boundary, each with the line in space that moves it, for the sums in balls
// (contour/arc_sum.h).
#pragma once

#include <span>
#include <vector>

#include "contour/arc_sum.h"
#include "gradient/kinks.h"
#include "visibility/plane_visibility.h"

namespace exactff::gradient {

// Adds the arcs of the boundary of one plane of the source, except those in the given planes through x.
//
// The edge engine's arcs come with their edges. Of the Booleans' boundary only the planes through x are used: the lines
// in each plane are found again from what meets it (sight_plane.h). So the two ways share little.
void add_moving_arcs(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary,
                     std::span<const SightResult> except, std::vector<contour::MovingArc>& arcs);

// Adds all arcs of the boundary, without their lines: those of V.
void add_contour_arcs(const visibility::VisibleBoundary& boundary, std::vector<contour::MovingArc>& arcs);

}  // namespace exactff::gradient
