// The arcs of the visible boundary, each with the line in space that moves it, for the sums in balls
// (contour/arc_sum.h).
#pragma once

#include <algorithm>
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

// Calls visit(pole) once for every plane through x in which the boundary has pieces, but for the receiver's horizon;
// the pole is its primitive normal.
template <class Visit>
void for_each_plane(const visibility::VisibleBoundary& boundary, const kernel::ExactVec3& horizon, const Visit& visit) {
  std::vector<kernel::ExactVec3> done;
  boundary.for_each_piece([&](const visibility::BoundaryPiece& piece) {
    kernel::ExactVec3 pole = cross(piece.a, piece.b);
    make_primitive(pole);
    const auto is_parallel = [&](const kernel::ExactVec3& other) { return is_zero(cross(pole, other)); };
    if (is_parallel(horizon) || std::ranges::any_of(done, is_parallel)) return;
    done.push_back(pole);
    visit(pole);
  });
}

// Adds all arcs of the boundary, without their lines: those of V.
void add_contour_arcs(const visibility::VisibleBoundary& boundary, std::vector<contour::MovingArc>& arcs);

}  // namespace exactff::gradient
