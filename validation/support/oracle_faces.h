// The faces of a scene as the oracle reads them: from vertices and rings alone, by its own judgement of what has no
// area, what is planar, and how a face that is not planar is cut.
#pragma once

#include <vector>

#include "exactff/scene.h"
#include "support/oracle_sum.h"

namespace exactff::validation {

// A planar polygon: inside is what an odd number of rings go round.
struct Polygon {
  FaceId face{};
  std::vector<Corners> rings;
  Vector normal;    // Newell vector of the first ring
  Rational offset;  // of its plane: normal . y = offset
};

// A face in coordinates whose origin is `origin`: one polygon, the triangles that the rule for faces out of plane
// gives, or nothing if it has no area.
[[nodiscard]] std::vector<Polygon> polygons_of(const Scene& scene, FaceId face, const Vector& origin);

// The same polygon seen from elsewhere.
[[nodiscard]] Polygon shifted(const Polygon& polygon, const Vector& by);

[[nodiscard]] Vector exact(const Vec3& v);

}  // namespace exactff::validation
