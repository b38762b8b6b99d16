// Random scenes that are difficult for an exact algorithm: corners on coarse lattices, shared and repeated edges, faces
// that touch, abut, cover exactly, or lie in the plane of the receiver, of the source or of each other.
#pragma once

#include <cstdint>
#include <ostream>
#include <span>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// About two in five receivers see part of the source, about as many see nothing, the others see all of it. The source
// is the patch `source`. Each occluder (mostly one face) is a separate patch.
[[nodiscard]] generate::PlainScene degenerate_scene(generate::Random& random);

// The same with coordinates of 53 bits in general position, and some edges 1 ulp beside others.
[[nodiscard]] generate::PlainScene generic_scene(generate::Random& random);

// One of the former in two of three cases, else one of the latter.
[[nodiscard]] generate::PlainScene random_scene(generate::Random& random);

// Degenerate scenes with some coordinates moved to a neighbouring double: almost coplanar, almost touching, cracks and
// overlaps of 1 ulp. Faces that the move makes invalid (self-crossing) are generated again.
[[nodiscard]] generate::PlainScene nudged_scene(generate::Random& random);

// Degenerate scenes cut into triangles and sheared: every coincidence is missed by a rounding error.
[[nodiscard]] generate::PlainScene sheared_scene(generate::Random& random);

// 20 to 60 faces of the family `lattice`: many coincidences at once.
[[nodiscard]] generate::PlainScene crowded_scene(generate::Random& random);

// Triangles before a triangle, with corners on a lattice and the receiver at the origin (see slid_along_rays).
[[nodiscard]] generate::PlainScene triangles_scene(generate::Random& random);

// triangles_scene with its corners moved along their rays to any distance between 2^-1000 and 2^1000.
[[nodiscard]] generate::PlainScene scene_of_all_magnitudes(generate::Random& random);

// Coincident faces: sheets that lie over each other in one plane or two, each facing either way
// (random_scenes_sheets.cpp).
[[nodiscard]] generate::PlainScene sheets_scene(generate::Random& random);

// Families whose corners lie on few rays from the receiver. Wherever the frame is exact, their coincidences survive
// full mantissas, axes scaled separately by powers of two, and subnormal coordinates (random_scenes_rays.cpp). If a
// scene has a patch `on`, its receiver lies on the only face of that patch.
struct RandomFamily {
  const char* name;
  std::uint64_t count;  // for a test with little time
  generate::PlainScene (*make)(generate::Random&);
};
inline void PrintTo(const RandomFamily& family, std::ostream* out) { *out << family.name; }
[[nodiscard]] std::span<const RandomFamily> families_on_rays();
// All of the above. Every test of what the program computes, draws or writes uses this list.
[[nodiscard]] std::span<const RandomFamily> random_families();

// How many scenes a test examines: `count` times the environment variable EXACTFF_TEST_SCALE (1 if unset).
[[nodiscard]] std::uint64_t scaled_count(std::uint64_t count);

// The seed for scene number `index` of a test: EXACTFF_TEST_SEED (1 if unset) mixed with the index.
[[nodiscard]] std::uint64_t seed_of(std::uint64_t index);

}  // namespace exactff::validation
