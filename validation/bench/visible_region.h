// The boundary of the visible region in the form that the contour needs, for all planes of a scene's source together.
#pragma once

#include <vector>

#include "bench/double_contour.h"
#include "bench/scenes.h"
#include "visibility/outlines.h"

namespace exactff::bench {

// By the edge engine, computed on first use.
[[nodiscard]] const std::vector<visibility::BoundaryPiece>& exact_boundary(const BenchScene& s);

// In doubles; replaces the content of `edges`.
void find_double_boundary(const BenchScene& s, Engine engine, std::vector<DoubleEdge>& edges);

// Eq. (4) in double over the result of an engine.
[[nodiscard]] double double_form_factor(const BenchScene& s, Engine engine);

}  // namespace exactff::bench
