// Random scenes on which an exact algorithm has to earn its name: corners on coarse lattices, shared and repeated
// edges, faces that touch, abut, cover exactly, lie in the receiver's, the source's or each other's plane.
#pragma once

#include <cstdint>
#include <span>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// Two in five receivers see part of the source, about as many see nothing, the rest all of it. The source is
// the patch `source`; each occluder (mostly one face) is a patch of its own.
[[nodiscard]] generate::PlainScene degenerate_scene(generate::Random& random);

// The same with coordinates of 53 bits in no special position, and some edges 1 ulp beside others.
[[nodiscard]] generate::PlainScene generic_scene(generate::Random& random);

// Degenerate scenes with some coordinates moved to a neighbouring double: almost coplanar, almost touching, cracks and
// overlaps of 1 ulp. Faces that the move spoils (crossing themselves) are drawn again.
[[nodiscard]] generate::PlainScene nudged_scene(generate::Random& random);

// Degenerate scenes cut into triangles and sheared: every coincidence is missed by a rounding.
[[nodiscard]] generate::PlainScene sheared_scene(generate::Random& random);

// 20 to 60 faces of the family `lattice`: many coincidences at once.
[[nodiscard]] generate::PlainScene crowded_scene(generate::Random& random);

// Triangles before a triangle, the receiver at the origin (see slid_along_rays), corners on a lattice.
[[nodiscard]] generate::PlainScene triangles_scene(generate::Random& random);

// triangles_scene with its corners slid along their rays to anywhere between 2^-1000 and 2^1000.
[[nodiscard]] generate::PlainScene scene_of_all_magnitudes(generate::Random& random);

// Families whose corners lie on few rays from the receiver and whose coincidences, wherever the frame is exact, survive
// full mantissas, axes scaled apart by powers of two and subnormal coordinates (random_scenes_rays.cpp). Where a scene
// has a patch `on`, its receiver lies on the only face of that patch.
struct RandomFamily {
  const char* name;
  std::uint64_t count;  // for a test that has little time
  generate::PlainScene (*make)(generate::Random&);
};
[[nodiscard]] std::span<const RandomFamily> families_on_rays();
// All of the above: what everything that the program computes, draws or writes is driven by.
[[nodiscard]] std::span<const RandomFamily> random_families();

// How many scenes a test looks at: `count` times the environment's EXACTFF_TEST_SCALE (1 if unset).
[[nodiscard]] std::uint64_t scaled_count(std::uint64_t count);

// The seed that numbered scene `index` of a test starts from: EXACTFF_TEST_SEED (1 if unset) mixed with the index.
[[nodiscard]] std::uint64_t seed_of(std::uint64_t index);

}  // namespace exactff::validation
