// The distance of a receiver from the face that it is declared to lie on.
#pragma once

#include "exactff/scene.h"

namespace exactff {

// The distance of a point from a face's bounding box or from its plane, whichever is larger, over the box's diagonal:
// an estimate, to find mistyped coordinates. For a face that is not planar, its own deviation is subtracted.
[[nodiscard]] double relative_distance_from_face(const Scene& scene, FaceId face, const Vec3& point);

}  // namespace exactff
