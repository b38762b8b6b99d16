// What the makers of receivers share.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "exactff/receiver.h"

namespace exactff {

// "NAME:k" even for a patch of one face.
[[nodiscard]] std::string numbered_name_of(const Scene& scene, FaceId face);

// Each face with area as a region.
[[nodiscard]] std::vector<Region> lone_regions(const Scene& scene, std::span<const FaceId> faces);

// The tolerance of find_faces for a point that was computed: 1e-6 of the scene's diameter, or two units in the last
// place of its largest coordinate in single precision.
[[nodiscard]] double tolerance_of_computed_points(const Scene& scene);

// The own faces of a receiver that lies on a face: that face first, then the others of its patch within the tolerance
// whose fronts agree with its front, as find_faces adds them.
[[nodiscard]] std::vector<FaceId> own_faces(const Scene& scene, FaceId face, const Vec3& point, double tolerance);

}  // namespace exactff
