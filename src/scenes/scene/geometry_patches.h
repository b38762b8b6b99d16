// How the angle between the fronts of two planes compares with a given one, decided exactly.
#pragma once

#include "exactff/scene.h"
#include "kernel/numbers.h"

namespace exactff {

// The sign of n . m - cos(degrees) |n| |m| for vectors other than 0, from 0 to 180 degrees: positive if the angle
// between them is smaller.
[[nodiscard]] int compare_angle(double degrees, const kernel::ExactVec3& n, const kernel::ExactVec3& m);

// A normal of the piece, towards its front: exact, of any length.
[[nodiscard]] kernel::ExactVec3 exact_normal(const Scene& scene, const Piece& piece);

}  // namespace exactff
