// Random frames for scenes: exact ones, which keep all coincidences, and rounded ones, which miss each by an ulp.
#pragma once

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// Either moves the scene by an affine map (full mantissas, axes scaled differently, subnormal coordinates), or rounds
// every coordinate, or changes nothing. If the coordinates are small integers, the maps are exact in doubles.
void move_to_a_random_frame(generate::PlainScene& scene, generate::Random& random);

// Corners get new numbers, which determine how non-planar faces are cut.
void renumber(generate::PlainScene& scene, generate::Random& random);

}  // namespace exactff::validation
