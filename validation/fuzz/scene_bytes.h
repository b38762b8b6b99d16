// Small degenerate scenes out of arbitrary bytes: what a coverage-guided fuzzer mutates.
//
// The bytes are a program. A header places the receiver and says how many faces the source has and which identity is
// tried; then each instruction adds one face (a new one, or a copy, neighbour, cover or tiling of what is there) or
// spoils the last one (spike, idle corner, ulp, slide along a ray). Coordinates are mostly small multiples of 1/4, so
// that coincidences are the rule; eight raw bytes can stand for any double. Faces that the scene builder would refuse
// are left out, so that nearly every input means a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "generate/plain_scene.h"

namespace exactff::validation {

// What must leave the answer as it is, or move it in a known direction.
enum class Identity : std::uint8_t {
  kOrder,
  kRetriangulation,
  kSymmetry,
  kScaling,
  kNormalLength,
  kTwinOccluder,
  kOneOccluderLess,
  kCuttersAlone,
  kIdleCorners,
  kSpikes,
  kObjText,
  kDrawing,
};
inline constexpr std::size_t kIdentityCount = 12;

struct FuzzCase {
  generate::PlainScene scene;
  Identity identity = Identity::kOrder;
  std::uint64_t seed = 0;  // of the identity's random choices
};

// Nothing where no face of the source can be used.
[[nodiscard]] std::optional<FuzzCase> decode(std::span<const std::uint8_t> bytes);

inline constexpr std::size_t kMaxFaces = 24;     // in all
inline constexpr std::size_t kMaxCorners = 200;  // in all

// Bytes that decode to this very scene: a way for known scenes into the corpus. Throws std::invalid_argument for one
// beyond the limits of the decoder. Requires finite numbers.
[[nodiscard]] std::vector<std::uint8_t> encode(const generate::PlainScene& scene, Identity identity);

}  // namespace exactff::validation
