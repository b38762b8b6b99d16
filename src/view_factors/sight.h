// What lies between two convex pieces: the pair's polygons, clipped once by each other's planes.
#pragma once

#include <optional>
#include <vector>

#include "view_factors/cell.h"
#include "view_factors/exact_scene.h"
#include "view_factors/polygons.h"

namespace exactff::view_factors {

struct Occluder {
  Ring ring;           // counter-clockwise as seen from the positive side of the plane
  const Plane* plane;  // of the scene
};

// A receiver's points see a source's points if the segment between them meets no occluder. Refers to the scene.
struct Sight {
  explicit Sight(const Units& units) : points(units) {}

  Points points;
  Plane receiver;  // positive in front
  Cell root;       // the part of the receiver in front of the source's plane
  Ring source;     // the part of the source in front of the receiver's plane, counter-clockwise as seen from there
  std::vector<Occluder> occluders;  // the parts in front of both planes
};

// A convex part of a patch: corners counter-clockwise as seen from the front, none in the middle of a straight side.
struct Part {
  FaceId face{};
  std::vector<Point> corners;
  bool is_piece = false;  // a whole piece of the scene
};

// Empty if no point of the receiver lies in front of the source, or the other way round: the factor is 0. `own` does
// not occlude.
[[nodiscard]] std::optional<Sight> sight_of(const ExactScene& scene, const Part& receiver, const Part& source,
                                            FaceId own);

}  // namespace exactff::view_factors
