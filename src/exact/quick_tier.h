// The first attempt at a certified value: the boundary that the edge engine found, integrated in double-double.
#pragma once

#include <cstdint>
#include <vector>

#include "contour/quick_contour.h"
#include "exactff/exact.h"
#include "visibility/visible_edges.h"

namespace exactff::exact {

class QuickTier {
 public:
  static constexpr int kBits = 106;  // of a double-double

  explicit QuickTier(const Vec3& normal) : contour_(normal) {}

  // The parts that the engine holds now.
  void add(visibility::VisibleEdges& edges);

  // The enclosure of F, at least as wide as the proved error; of every number where a piece was declined.
  [[nodiscard]] Enclosure enclosure() const;

 private:
  [[nodiscard]] std::uint32_t corner(visibility::Outlines& outlines, visibility::CornerId id);
  [[nodiscard]] contour::QuickEnd end(visibility::Outlines& outlines, const visibility::VisibleEdges::Parameter& p);

  contour::QuickContour contour_;
  std::vector<contour::QuickCorner> corners_;
  std::vector<std::uint32_t> index_;  // into corners_, by the engine's corner
};

}  // namespace exactff::exact
