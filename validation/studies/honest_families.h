// Scenes made to break what is claimed of view factors: patches "floor" and "source", with "occ" between where
// something hides.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "exactff/scene.h"

namespace exactff::experiments {

inline constexpr std::array<std::string_view, 8> kHardFamilies{
    "thin gap",       // plates 1 to 1e-9 apart, a cover between that a corner of any size is cut off
    "near parallel",  // a plate over another, tilted by 1e-1 to 1e-9, 1 to 1e-4 apart
    "cut corner",     // plates 1 apart, the cover anywhere between
    "slit",           // two covers that leave a slit of 1e-1 to 1e-6
    "far away",       // one of the others, 5e6 from the origin
    "sizes",          // patches whose sizes have a ratio of up to 1e18
    "sheets",         // a source, and a cover, of two faces each in one plane with opposite fronts
    "hole",           // a cover with a hole of 1e-1 to 1e-4 that no edge of the plates is near
};

// Depends on the two numbers alone.
[[nodiscard]] Scene hard_scene(std::size_t family, std::uint64_t seed);

}  // namespace exactff::experiments
