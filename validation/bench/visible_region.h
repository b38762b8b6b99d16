// The visible region's boundary as the contour wants it, for every plane of a scene's source together.
#pragma once

#include <vector>

#include "bench/double_contour.h"
#include "bench/scenes.h"
#include "visibility/boundary_piece.h"

namespace exactff::bench {

// By the edge engine, computed when first asked for.
[[nodiscard]] const std::vector<visibility::BoundaryPiece>& exact_boundary(const BenchScene& s);

// In doubles; what `edges` held before is gone.
void find_double_boundary(const BenchScene& s, Engine engine, std::vector<DoubleEdge>& edges);

// Eq. (4) in double over what an engine finds.
[[nodiscard]] double double_form_factor(const BenchScene& s, Engine engine);

}  // namespace exactff::bench
