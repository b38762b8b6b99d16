// Decodes arbitrary bytes to small degenerate scenes, for a coverage-guided fuzzer to mutate.
//
// The bytes are a program. A header places the receiver and gives the number of faces of the source. Then each
// instruction adds one face (a new one, or a copy, neighbour, cover or tiling of existing ones) or modifies the last
// face (spike, idle corner, ulp, slide along a ray). Coordinates are mostly small multiples of 1/4, so that
// coincidences are the rule; eight raw bytes can stand for any double. Faces that the scene builder would refuse are
// left out, so that nearly every input gives a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "generate/plain_scene.h"

namespace exactff::validation {

struct FuzzCase {
  generate::PlainScene scene;
  std::uint64_t seed = 0;  // of the random choices of a judge
};

// Nothing if no face of the source can be used.
[[nodiscard]] std::optional<FuzzCase> decode(std::span<const std::uint8_t> bytes);

inline constexpr std::size_t kMaxFaces = 24;     // in total
inline constexpr std::size_t kMaxCorners = 200;  // in total

}  // namespace exactff::validation
