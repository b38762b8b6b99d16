// Eq. (4) in plain double over visible edges: the cost of the value without a proof.
#pragma once

#include <span>

#include "exactff/geometry.h"
#include "visibility/outlines.h"
#include "visibility/visible_edges.h"

namespace exactff::bench {

// Directions from x to the ends of a boundary piece.
struct DoubleEdge {
  Vec3 p, q;
};

[[nodiscard]] DoubleEdge to_double(const visibility::BoundaryPiece& piece);

// Estimates F. Requires a normal other than zero.
[[nodiscard]] double form_factor(std::span<const DoubleEdge> edges, const Vec3& normal);

// Estimates F from the edge engine's result for one plane, four parts at a time.
[[nodiscard]] double form_factor(const visibility::EdgeCovers& visible, const Vec3& normal);

}  // namespace exactff::bench
