// Changes of a scene that must leave the form factor's bits as they are, or move them in a known direction.
#pragma once

#include <array>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// An element of the cube's symmetry group: new coordinate k = sign[k] * old coordinate axis[k].
struct Symmetry {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  [[nodiscard]] bool odd() const;  // mirrors space
};
[[nodiscard]] std::vector<Symmetry> all_symmetries();  // 48, the identity first

// Rings run the other way under odd symmetries, so that fronts stay fronts.
[[nodiscard]] generate::PlainScene turned(const generate::PlainScene& scene, const Symmetry& symmetry);

// The order of patches, faces and vertices and the first corner of every ring drawn anew.
[[nodiscard]] generate::PlainScene shuffled(const generate::PlainScene& scene, generate::Random& random);

// Every planar face outside the source cut into triangles, with fans from random corners and splits at points halfway
// between two corners where those are doubles. Other faces stay.
[[nodiscard]] generate::PlainScene retriangulated(const generate::PlainScene& scene, generate::Random& random);

// Corners repeated, and corners put halfway along straight sides where that is a double. Scenes
// with a face that is not planar stay as they are: another corner would give it another surface.
[[nodiscard]] generate::PlainScene with_idle_corners(const generate::PlainScene& scene, generate::Random& random);

// Rings of convex faces made to walk from a corner to a point inside and back the same way, in one step or two.
[[nodiscard]] generate::PlainScene with_spikes(const generate::PlainScene& scene, generate::Random& random);

// Every corner moved along its ray from the receiver by a power of two of its own: occluders' towards the receiver,
// the source's away from it, by up to 2^range. The cones stay, and so does F (but not the visible fraction). Requires
// a receiver at the origin, triangles only, and every occluder nearer than the plane of the source.
[[nodiscard]] generate::PlainScene slid_along_rays(const generate::PlainScene& scene, int range,
                                                   generate::Random& random);

// Sheared by a random matrix near the identity, every coordinate rounded: what met exactly now almost meets, and
// mantissas are full. The receiver's normal is sheared like a point.
[[nodiscard]] generate::PlainScene sheared(const generate::PlainScene& scene, generate::Random& random);

// Every tenth coordinate or so moved to the next double up or down.
[[nodiscard]] generate::PlainScene nudged(const generate::PlainScene& scene, generate::Random& random);

}  // namespace exactff::validation
