// The first attempt at a certified value: integrates the boundary that the edge engine found in double-double
// arithmetic.
#pragma once

#include "contour/quick_contour.h"
#include "kernel/ball.h"
#include "visibility/visible_edges.h"

namespace exactff::exact {

class QuickTier {
 public:
  static constexpr int kBits = 106;  // precision of a double-double

  explicit QuickTier(const Vec3& normal) : contour_(normal) {}

  // Adds the parts that the edge engine currently holds.
  void add(visibility::VisibleEdges& edges);

  // Encloses F; its radius is at least the proved error. The ball contains every number if a piece was declined.
  [[nodiscard]] Ball ball() const;

 private:
  contour::QuickContour contour_;
};

}  // namespace exactff::exact
