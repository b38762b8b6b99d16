// Pieces that lie in nearly one plane and cover each other.
#pragma once

#include <cstdint>
#include <optional>

#include "exactff/slips.h"
#include "slips/sight_lines.h"

namespace exactff::slips {

struct PieceOverlap {
  double area = 0.0;
  double apart = 0.0;  // largest distance of the smaller piece from the larger one's plane; 0: exactly one plane
};

// Nothing if less than a millionth of the smaller piece is covered: then they only touch, but for roundings of their
// corners. If they lie in two planes, less than a ten-thousandth, or more than a millionth of the larger piece's
// diameter, and more than `reach`, from each other. The fronts may be the same or opposite.
[[nodiscard]] std::optional<PieceOverlap> overlap_of(const Scene& scene, const SightLines& sight, std::uint32_t a,
                                                     std::uint32_t b, double reach = 0.0);

[[nodiscard]] double piece_area(const Scene& scene, const SightLines& sight, std::uint32_t piece);

}  // namespace exactff::slips
