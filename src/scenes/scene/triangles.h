// The triangles of a piece of a face.
#pragma once

#include <cstdint>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// Vertex indices, at the corners of the piece and counter-clockwise from the front. They cover the piece exactly.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> triangles_of(const Scene& scene, const Piece& piece);

}  // namespace exactff
