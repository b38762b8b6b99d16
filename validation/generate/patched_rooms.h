// Scenes for the times of view factors: closed, every face a patch of its own, with exactly planar faces.
#pragma once

#include "generate/families.h"

namespace exactff::models {

// A room of 1 x 1 x 1, each wall in n x n patches, and in its middle a cube, tilted about all axes.
[[nodiscard]] PlainScene cube_room(const FamilyOptions& options);
// The same room with three cubes. Two of them stand on the floor, turned about the upright axis; one touches a wall.
[[nodiscard]] PlainScene three_cube_room(const FamilyOptions& options);
// A building of 8 x 4 rooms of 3 x 3 x 3 in one shell, whose patches are squares of 1 / n. Partitions are boxes with a
// doorway, and in each room stand four boxes: n = 2 gives about 5,000 patches.
[[nodiscard]] PlainScene building(const FamilyOptions& options);

[[nodiscard]] std::span<const Family> patched_rooms();

}  // namespace exactff::models
