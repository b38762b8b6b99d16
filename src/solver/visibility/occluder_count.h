// Counts occluders by a ray: those that x sees on both sides of a point of an edge. By filters alone.
#pragma once

#include <optional>

#include "visibility/silhouettes.h"

namespace exactff::visibility {

// A direction from x: the point of an edge with a parameter.
[[nodiscard]] kernel::Approx3 between(const Outlines::Corner& a, const Outlines::Corner& b, double t);
// Two directions about orthogonal to d and to each other, with components of at most 1.
void find_axes(const kernel::Approx3& d, kernel::Approx3& u, kernel::Approx3& v);

class OccluderCount {
 public:
  struct Counts {
    int left = 0, right = 0;
  };

  // Requires what gather has found.
  OccluderCount(const PlaneQuery& query, Outlines& outlines, Silhouettes& silhouettes)
      : query_(query), outlines_(outlines), silhouettes_(silhouettes) {}

  // Just beside the point with the parameter m / (l + m) = t / ((1 - t) + t), both as doubles. Nullopt where doubles do
  // not tell.
  [[nodiscard]] std::optional<Counts> beside(EdgeId edge, double t);

 private:
  [[nodiscard]] std::optional<int> sides_of(std::uint32_t piece, int facing, EdgeId edge, double t);

  const PlaneQuery& query_;
  Outlines& outlines_;
  Silhouettes& silhouettes_;
};

}  // namespace exactff::visibility
