// Changes of a scene that must leave the bits of the form factor unchanged, or change it in a known direction.
#pragma once

#include <array>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// An element of the symmetry group of the cube: new coordinate k = sign[k] * old coordinate axis[k].
struct Symmetry {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  [[nodiscard]] bool odd() const;  // a mirroring
};
[[nodiscard]] std::vector<Symmetry> all_symmetries();  // 48, the identity first

// Odd symmetries also reverse the rings, so that fronts stay fronts.
[[nodiscard]] generate::PlainScene turned(const generate::PlainScene& scene, const Symmetry& symmetry);

// Shuffles patches, faces and vertices, and starts every ring at a random corner.
[[nodiscard]] generate::PlainScene shuffled(const generate::PlainScene& scene, generate::Random& random);

// Cuts every planar face outside the source into triangles, with fans from random corners and splits at points halfway
// between two corners if those points are doubles. Other faces stay.
[[nodiscard]] generate::PlainScene retriangulated(const generate::PlainScene& scene, generate::Random& random);

// Repeats corners, and adds corners halfway along straight sides if the point is a double. Scenes with a face that is
// not planar stay unchanged: another corner would change its surface.
[[nodiscard]] generate::PlainScene with_idle_corners(const generate::PlainScene& scene, generate::Random& random);

// Makes rings of convex faces go from a corner to a point inside and back the same way, in one step or two.
[[nodiscard]] generate::PlainScene with_spikes(const generate::PlainScene& scene, generate::Random& random);

// Moves every corner along its ray from the receiver, each by its own power of two: corners of occluders towards the
// receiver, those of the source away from it, by up to 2^range. The cones are unchanged, and so is F (but not the
// visible fraction). Requires a receiver at the origin, triangles only, and every occluder nearer than the plane of the
// source.
[[nodiscard]] generate::PlainScene slid_along_rays(const generate::PlainScene& scene, int range,
                                                   generate::Random& random);

// Every face cut into triangles, so that it stays planar when a vertex moves. Of the source one triangle is left, or
// none.
[[nodiscard]] generate::PlainScene in_triangles(const generate::PlainScene& scene);

// Whether there is a source, and no face without area.
[[nodiscard]] bool has_only_area(const generate::PlainScene& scene);

// Shears the scene by a random matrix near the identity and rounds every coordinate: what met exactly now almost meets,
// and mantissas are full. The receiver's normal is sheared like a point.
[[nodiscard]] generate::PlainScene sheared(const generate::PlainScene& scene, generate::Random& random);

// Moves about every tenth coordinate to the next double up or down.
[[nodiscard]] generate::PlainScene nudged(const generate::PlainScene& scene, generate::Random& random);

}  // namespace exactff::validation
