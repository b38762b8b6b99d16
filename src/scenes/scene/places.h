// Finds the vertices that lie at one position. A vertex index that identifies a position is called a place.
#pragma once

#include <cstdint>
#include <span>

#include "exactff/scene.h"

namespace exactff {

// For every vertex the lowest index of a vertex at its position. Computed at the first
// call; safe to call from several threads.
[[nodiscard]] std::span<const std::uint32_t> places(const Scene& scene);

}  // namespace exactff
