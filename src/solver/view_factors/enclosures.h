// Closed surfaces around all that a part of a patch sees, so that nothing outside of them is seen.
//
// Let S be a closed surface with winding number w (scene/closed_surfaces.h), and let w just above a point x of the part
// be other than 0. Almost every ray from there crosses pieces of S whose signs add up to w, and so at least one piece
// that is not in the part's plane. None is the receiver's own face, which lies in that plane: the ray is blocked.
//
// w is found above one point x by a ray from it, exactly. It is the same above all of the part if above its interior,
// near enough, no piece of S is met. That holds for a piece with no corner in front of the part's plane. Otherwise the
// piece must not meet the part's interior, and does not in two cases:
// - The part lies on one side of the piece's plane, not all of it in that plane.
// - The plane through an edge of the part, along the part's normal, has all of the piece's corners on its outer side
//   or in it. If no corner lies behind the part's plane, only those in it count: their convex hull is what the piece
//   has in common with that plane.
#pragma once

#include <vector>

#include "view_factors/exact_scene.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

class Enclosures {
 public:
  // Keeps a reference.
  explicit Enclosures(const ExactScene& scene);

  // False does not mean that anything outside is seen. Transparent pieces belong to no closed surface, and pieces of
  // faces that are not planar are not enclosed: at their points, other pieces of their face hide nothing.
  [[nodiscard]] bool stand_around(const Part& part) const;

 private:
  const ExactScene& scene_;
  std::vector<ExactSurface> surfaces_;  // with edges cut at T-junctions
};

}  // namespace exactff::view_factors
