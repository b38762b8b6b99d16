// Random meshes between a receiver and a source: what a search by silhouettes has to get right.
#pragma once

#include <span>
#include <vector>

#include "support/random_scenes.h"

namespace exactff::validation {

// Closed and open surfaces, tori and Moebius strips, with corners on a lattice or in general position. Some are turned
// over in part, have holes, repeated faces, cut faces whose neighbours are not cut (T-junctions), a second mesh that
// touches them in a corner or an edge, or a copy moved by one unit in the last place. Many reach through the source's
// plane and through the horizon; the source may be a part of the mesh, and the receiver may lie on it, on a face of the
// patch `on` if there is one.
[[nodiscard]] std::span<const RandomFamily> mesh_families();

// The receiver of the scene, the same moved a little, and the same on some face of the scene.
[[nodiscard]] std::vector<Receiver> receivers_about(const Scene& scene, const generate::PlainScene& plain,
                                                    generate::Random& random);

}  // namespace exactff::validation
