// The faces of a scene as the oracle reads them: from vertices and rings alone. It decides independently what has no
// area, what is planar, and how a face that is not planar is cut.
#pragma once

#include <vector>

#include "exactff/scene.h"
#include "support/oracle_sum.h"

namespace exactff::validation {

// A planar polygon. A point is inside if an odd number of rings enclose it.
struct Polygon {
  FaceId face{};
  std::vector<Corners> rings;
  Vector normal;     // Newell vector of the first ring
  Rational offset;   // the plane is normal . y = offset
  bool own = false;  // it neither hides nor illuminates the receiver
};

// The face in coordinates relative to `origin`: one polygon; the triangles that the rule for non-planar faces gives; or
// nothing if the face has no area.
[[nodiscard]] std::vector<Polygon> polygons_of(const Scene& scene, FaceId face, const Vector& origin);

// The same after a movement of the vertices at one place.
struct MovedPlace {
  Vec3 place;
  Vector by;
};
[[nodiscard]] std::vector<Polygon> polygons_of(const Scene& scene, FaceId face, const Vector& origin,
                                               const MovedPlace& moved);

// The same polygon relative to another origin.
[[nodiscard]] Polygon shifted(const Polygon& polygon, const Vector& by);

[[nodiscard]] Vector exact(const Vec3& v);

}  // namespace exactff::validation
