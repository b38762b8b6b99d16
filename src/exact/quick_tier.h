// The first attempt at a certified value: the boundary that the edge engine found, integrated in double-double.
#pragma once

#include "contour/quick_contour.h"
#include "kernel/ball.h"
#include "visibility/visible_edges.h"

namespace exactff::exact {

class QuickTier {
 public:
  static constexpr int kBits = 106;  // of a double-double

  explicit QuickTier(const Vec3& normal) : contour_(normal) {}

  // The parts that the engine holds now.
  void add(visibility::VisibleEdges& edges);

  // Encloses F, at least as wide as the proved error; of every number where a piece was declined.
  [[nodiscard]] Ball ball() const;

 private:
  contour::QuickContour contour_;
};

}  // namespace exactff::exact
