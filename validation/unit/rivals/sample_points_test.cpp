#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "adaptive/sub_patch.h"
#include "unit/rivals/sampled_rays.h"

namespace exactff::adaptive {
namespace {

constexpr std::array kPatterns = {SamplePattern::kCentre, SamplePattern::kRegular, SamplePattern::kJittered,
                                  SamplePattern::kLowDiscrepancy};

const std::vector<Vec3> kTriangle = {{0, 0, 1}, {0, 2, 1}, {3, 0, 1}};
const std::vector<Vec3> kSquare = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
const std::vector<Vec3> kTrapezium = {{0, 0, 1}, {0, 3, 1}, {1, 1, 1}, {1, 0, 1}};

// Twice the area of the triangle a, b, p as seen from above.
double side(const Vec3& a, const Vec3& b, const Vec3& p) {
  return (p.x - a.x) * (b.y - a.y) - (p.y - a.y) * (b.x - a.x);
}

bool inside(const std::vector<Vec3>& polygon, const Vec3& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (side(polygon[i], polygon[(i + 1) % polygon.size()], p) < -1e-12) return false;
  }
  return true;
}

TEST(SamplePlan, CentreIsOnePointAtTheCentroid) {
  EXPECT_EQ(points(place(make_sub_patch(kSquare), SamplePattern::kCentre, 9)), (std::vector<Vec3>{{0.5, 0.5, 1.0}}));
  const std::vector<Vec3> centre = points(place(make_sub_patch(kTriangle), SamplePattern::kCentre, 9));
  ASSERT_EQ(centre.size(), 1U);
  EXPECT_DOUBLE_EQ(centre[0].x, 1.0);
  EXPECT_DOUBLE_EQ(centre[0].y, 2.0 / 3.0);
}

TEST(SamplePlan, PutsEveryPointInsideThePatch) {
  for (const SamplePattern pattern : kPatterns) {
    for (const auto* polygon : {&kTriangle, &kSquare, &kTrapezium}) {
      for (const Vec3& p : points(place(make_sub_patch(*polygon), pattern, 61))) EXPECT_TRUE(inside(*polygon, p));
    }
  }
}

TEST(SamplePlan, JitteredPutsOnePointInEachOfNCellsOfEqualArea) {
  for (const int rays : {1, 2, 3, 5, 7, 12, 16, 31}) {
    const auto rows = static_cast<int>(std::lround(std::sqrt(rays)));
    std::vector<int> per_row(static_cast<std::size_t>(rows), 0);
    for (const Vec3& p : points(place(make_sub_patch(kSquare), SamplePattern::kJittered, rays))) {
      int row = 0;  // v runs along x here; row k reaches up to its share of the cells
      while (p.x * rays >= (row + 1) * rays / rows) ++row;
      ++per_row[static_cast<std::size_t>(row)];
    }
    for (int k = 0; k < rows; ++k) {
      EXPECT_EQ(per_row[static_cast<std::size_t>(k)], (k + 1) * rays / rows - k * rays / rows) << rays;
    }
  }
}

// Every interval [k/n, (k+1)/n) of the shifted first coordinate holds one of Hammersley's n points.
TEST(SamplePlan, LowDiscrepancyIsEquidistributed) {
  constexpr std::size_t kRays = 64;
  std::array<int, kRays> count{};
  const std::vector<Vec3> placed = points(place(make_sub_patch(kSquare), SamplePattern::kLowDiscrepancy, kRays));
  const double shift = placed[0].y;
  for (const Vec3& p : placed) {
    const double u = p.y - shift < -1e-9 ? p.y - shift + 1.0 : p.y - shift;
    ++count[static_cast<std::size_t>(std::lround(u * kRays)) % kRays];
  }
  for (const int c : count) EXPECT_EQ(c, 1);
}

TEST(SplitPatch, TilesThePatchWithFourOfItsKind) {
  for (const auto* polygon : {&kTriangle, &kSquare, &kTrapezium}) {
    const SubPatch s = make_sub_patch(*polygon);
    double sum = 0.0;
    for (const SubPatch& part : split_patch(s)) {
      EXPECT_EQ(part.shape, s.shape);
      sum += area(part);
      for (int i = 0; i < part.corner_count(); ++i) EXPECT_TRUE(inside(*polygon, part.corner(i)));
    }
    EXPECT_DOUBLE_EQ(sum, area(s));
  }
}

TEST(ClipByHorizon, KeepsThePartAbove) {
  const std::vector<Vec3> wall = {{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}};
  std::vector<Vec3> clipped;
  clip_by_horizon(wall, {0, 0, 1}, clipped);
  EXPECT_EQ(clipped, (std::vector<Vec3>{{0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {0, 0, 0}}));
}

TEST(ClipByHorizon, LeavesNothingOfWhatOnlyTouchesIt) {
  const std::vector<Vec3> wall = {{0, 0, -1}, {0, 1, -1}, {0, 1, 0}, {0, 0, 0}};
  std::vector<Vec3> clipped;
  clip_by_horizon(wall, {0, 0, 1}, clipped);
  EXPECT_TRUE(clipped.empty());
}

}  // namespace
}  // namespace exactff::adaptive
