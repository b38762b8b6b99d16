// A form factor in plain doubles, for means of many points: the second opinion (oracle.h) takes a millisecond, this
// takes microseconds. It shares only the scene's convex pieces with the solver. Convex fragments of the source are cut
// by the planes through x and the edges of each occluder; what is left is integrated by the contour formula with acos.
//
// Which corners lie in front of a plane is decided exactly, so that touching pieces hide nothing. Everything else is
// rounded: near a face or an edge, values may be off by some 10^-9.
#pragma once

#include <vector>

#include "exactff/scene.h"

namespace exactff::validation {

class PlainFactor {
 public:
  enum class Occluders { kAll, kNone };

  // From points of a planar face to a patch of planar faces, none of which overlap in one plane.
  PlainFactor(const Scene& scene, FaceId from, const Selection& to, Occluders occluders = Occluders::kAll);

  [[nodiscard]] double at(const Vec3& x) const;

 private:
  using Polygon = std::vector<Vec3>;
  struct Source {
    Polygon corners;
    std::vector<Polygon> occluders;  // the parts in front of both planes
  };

  Vec3 normal_;
  std::vector<Source> sources_;
};

}  // namespace exactff::validation
