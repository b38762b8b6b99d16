// Closed surfaces between two parts of patches, or around all that a part sees.
//
// Let S be a closed surface with winding number w (scene/closed_surfaces.h). If w just above a point x of one part
// differs from w just above a point y of another one, then almost every segment from such an x to such a y crosses
// pieces of S whose signs add up to the difference, and so at least one piece. It lies in the plane of neither part:
// the segment is blocked. Far away from S, w is 0: if it is other than
// 0 just above x, so is almost every ray from there.
//
// If S has holes in a plane, all this holds on its side of the plane, for parts that lie there and, if in the plane,
// look away from it: the segment does not meet the plane. But a ray may leave through a hole.
//
// w is found above one point of a part by a ray from it, exactly. It is the same above all of the part if above its
// interior, near enough, no piece of S is met. That holds for a piece with no corner in front of the part's plane.
// Otherwise the piece must not meet the part's interior, and does not in three cases:
// - Their boxes are apart.
// - The part lies on one side of the piece's plane, not all of it in that plane.
// - The plane through an edge of the part, along the part's normal, has all of the piece's corners on its outer side
//   or in it. If no corner lies behind the part's plane, only those in it count: their convex hull is what the piece
//   has in common with that plane.
#pragma once

#include <optional>
#include <vector>

#include "view_factors/exact_scene.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// Of every closed surface, just above all of a part; nothing where it is not proved to be the same.
using Windings = std::vector<std::optional<int>>;

class Enclosures {
 public:
  // Keeps a reference.
  explicit Enclosures(const ExactScene& scene);

  // Transparent pieces belong to no closed surface.
  [[nodiscard]] Windings above(const Part& part) const;
  // Whether nothing outside of closed surfaces is proved to be seen. False does not mean that anything is.
  [[nodiscard]] bool are_around(const Windings& windings) const;

 private:
  const ExactScene& scene_;
  std::vector<ExactSurface> surfaces_;  // with edges cut at T-junctions
};

// Whether the parts are proved to see nothing of each other. False does not mean that they see something.
[[nodiscard]] bool are_separated(const Windings& one, const Windings& other);

}  // namespace exactff::view_factors
