// Families of scenes. Each is generated from a seed and is the same on every machine: only + - * / and square roots of
// doubles are used, for which IEEE 754 prescribes the rounding.
//
// Unless stated otherwise, the receiver is the origin looking along +z, the source is the square [-1,1]^2 at z = 1
// facing it (patch `source`), and everything else is the patch `occ`.
#pragma once

#include <cstdint>

#include "models/plain_scene.h"

namespace exactff::models {

struct FamilyOptions {
  int n = 50;
  std::uint64_t seed = 1;
  double cover = 1.0;  // random families: total area of all shadows, as a multiple of the source's
  int drop = 0;        // tiles: leaves out every drop-th tile; 0 leaves out none
};

// n triangles parallel to the source, between it and the receiver (Karkanis' test data: one normal for all).
[[nodiscard]] PlainScene karkanis(const FamilyOptions& options);
// n triangles of any orientation in and around the pyramid between receiver and source. A few extend behind the
// receiver or beyond the source.
[[nodiscard]] PlainScene soup(const FamilyOptions& options);
// n parallel tilted slats across the pyramid, half of which stays open.
[[nodiscard]] PlainScene blinds(const FamilyOptions& options);
// n x n abutting squares that hide the source exactly. Corners are dyadic if n is a power of two, otherwise rounded
// decimals.
[[nodiscard]] PlainScene tiles(const FamilyOptions& options);
// A closed sphere of about n triangles (a subdivided octahedron) in front of the source.
[[nodiscard]] PlainScene mesh(const FamilyOptions& options);
// n triangles and squares with corners on a lattice of 1/64. They often share edges, lie in each other's planes or in
// those of the source and the receiver, and repeat each other.
[[nodiscard]] PlainScene lattice(const FamilyOptions& options);
// A room, in metres, with a window (the emitter and source, patch `window`), a blind of n slats before it, a table and
// a floor. The receiver lies on the table top. Seed, cover and drop have no effect.
[[nodiscard]] PlainScene room(const FamilyOptions& options);

}  // namespace exactff::models
