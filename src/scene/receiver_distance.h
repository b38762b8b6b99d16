// How far a receiver is from the face that it is said to lie on.
#pragma once

#include "exactff/scene.h"

namespace exactff {

// The distance of a point from a face's bounding box or from its plane, whichever is larger, over the box's diagonal:
// an estimate, to find what was mistyped. A face that is not planar gets its own deviation forgiven.
[[nodiscard]] double relative_distance_from_face(const Scene& scene, FaceId face, const Vec3& point);

}  // namespace exactff
