// Small polygons of the visible share (exact/visible_share.h).
#include <gtest/gtest.h>

#include <stdexcept>

#include "exact/visible_share.h"

namespace exactff::exact {
namespace {

using Polygon = SmallPolygon<double>;

// Corners on both sides of the u axis in turn: what roundings may make of corners near the axis.
Polygon zigzag(std::size_t corners) {
  Polygon result;
  for (std::size_t k = 0; k < corners; ++k) result.push_back({static_cast<double>(k), k % 2 == 0 ? 1.0 : -1.0});
  return result;
}

TEST(SmallPolygon, HoldsWhatThreeCutsLeaveOfFourCorners) {
  std::size_t corners = 4;
  for (const std::size_t left : {6, 9, 13}) {
    corners = left_part(zigzag(corners), {0.0, 0.0}, {1.0, 0.0}).size();
    EXPECT_EQ(corners, left);
  }
  EXPECT_EQ(corners, Polygon::kMost);
}

TEST(SmallPolygon, RefusesAnotherCorner) {
  Polygon full = zigzag(Polygon::kMost);
  EXPECT_THROW(full.push_back({0.0, 0.0}), std::logic_error);
  EXPECT_EQ(full.size(), Polygon::kMost);
}

}  // namespace
}  // namespace exactff::exact
