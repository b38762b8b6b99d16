// Subsurfaces of View3D: surfaces that lie in another one, their base, and take their area from it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff::formats {

// True if all vertices are exactly in one plane.
[[nodiscard]] bool in_one_plane(std::span<const Vec3> vertices);

// A base has its subsurfaces as holes. By the even-odd rule, a part that two holes cover would belong to the base
// again. True if this is not so and every hole lies in the base, exactly: what is left of the base and its subsurfaces
// have the same total area as the whole base. `base` and `subsurfaces` are in one plane and in the scene.
[[nodiscard]] bool are_parts(const Scene& scene, FaceId base, std::span<const FaceId> subsurfaces);

// True if the subsurface has the front of its base, or no area.
[[nodiscard]] bool same_front(const Scene& scene, FaceId base, FaceId subsurface);

}  // namespace exactff::formats
