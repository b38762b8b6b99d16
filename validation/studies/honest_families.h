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

// Rooms, dishes and streets that almost close: a corner or a wall is off by 1e-15 to 1e-3.
inline constexpr std::array<std::string_view, 7> kAlmostClosedFamilies{
    "moved corners",  // a box room of six quads, perhaps with a plate inside, every corner of every face moved
    "shifted walls",  // every wall moved along its normal
    "tilted walls",   // two corners of every wall moved along its normal
    "overlaps",       // every wall as much larger or smaller than the room on all sides
    "slivers",        // thin triangles along the edges of the room
    "dish",           // a dish of 10 to 60 facets under a plate, every corner moved
    "streets",        // 2 x 2 houses on tiles, every corner moved; from one of the tiles to walls
};

// Depends on the two numbers alone. Families are counted on from kHardFamilies to kAlmostClosedFamilies.
[[nodiscard]] Scene hard_scene(std::size_t family, std::uint64_t seed);

}  // namespace exactff::experiments
