// Solid angles in doubles.
#pragma once

#include <cstdint>
#include <span>

#include "exactff/scene.h"

namespace exactff::slips {

// The sum of the signed solid angles of the pieces: 4 pi times the winding number of a closed surface, negative inside
// one whose fronts look outward. Counts its triangles.
[[nodiscard]] double solid_angle_of(const Scene& scene, std::span<const std::uint32_t> pieces, const Vec3& point,
                                    std::uint64_t& triangles);

}  // namespace exactff::slips
