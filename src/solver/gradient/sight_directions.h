// A plane through x, and the directions in it.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "visibility/outlines.h"

namespace exactff::gradient {

class SightDirections {
 public:
  [[nodiscard]] const kernel::ExactVec3& normal() const { return normal_; }

 protected:
  // The plane through x and the edge; N is its inward normal.
  SightDirections(visibility::Outlines& outlines, const visibility::Outlines::Edge& edge);

  // The sign of N . (p x q).
  [[nodiscard]] int turn(const kernel::ExactVec3& p, const kernel::ExactVec3& q) const;
  // Requires that `from` and `to` are less than a half turn apart.
  [[nodiscard]] bool is_between(const kernel::ExactVec3& from, const kernel::ExactVec3& to,
                                const kernel::ExactVec3& t) const;

  // On which side of the plane each corner of the outline lies, edge by edge.
  [[nodiscard]] std::vector<int> sides_of(visibility::Outlines& outlines, visibility::OutlineId id) const;
  // On which side the outline with these corners lies; 0: on both.
  [[nodiscard]] static int side_of(std::span<const int> sides);
  // The arc along which the outline with these corners meets the plane, from its end of the smallest angle on.
  [[nodiscard]] std::optional<std::pair<kernel::ExactVec3, kernel::ExactVec3>> arc_of(visibility::Outlines& outlines,
                                                                                      visibility::OutlineId id,
                                                                                      std::span<const int> sides) const;

  visibility::Outlines::Edge edge_;
  kernel::ExactVec3 normal_;
};

}  // namespace exactff::gradient
