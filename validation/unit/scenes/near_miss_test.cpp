// One unit in the last place decides: an occluder hides if it is that much nearer than the source or inside the shaft,
// and hides nothing on the limit or beyond it. The receivers' coordinates make every difference round.
#include <gtest/gtest.h>

#include <cmath>

#include "generate/plain_scene.h"
#include "support/solve.h"

namespace exactff {
namespace {

using generate::PlainScene;
using Corners = std::vector<Vec3>;

// Source [-1,1]^2 at z = 1 facing down, one occluder, the receiver below facing up.
PlainScene scene_with(const Corners& occluder, const Vec3& receiver) {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}});
  scene.add_ring(scene.patch("occluder"), occluder);
  scene.point = receiver;
  return scene;
}

std::vector<Vec3> receivers() {
  std::vector<Vec3> points;
  for (int i = -4; i <= 4; ++i) {
    for (int k = -9; k <= 9; ++k) points.push_back({i / 10.0, i / 30.0, k / 10.0});
  }
  return points;
}

// What a receiver sees of the source behind each occluder.
void expect_everywhere(const Corners& occluder, VisiblePart expected) {
  for (const Vec3& receiver : receivers()) {
    const FormFactor result = validation::solve(scene_with(occluder, receiver), {.visible_fraction = true});
    ASSERT_EQ(to_string(result.visible_part.value()), to_string(expected))
        << "from " << receiver.x << ' ' << receiver.y << ' ' << receiver.z;
  }
}

const double kBefore = std::nextafter(1.0, 0.0);
const double kAfter = std::nextafter(1.0, 2.0);

Corners square(double half, double z) {
  return {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
}

TEST(NearMiss, OneUlpBeforeTheSourceHides) {
  expect_everywhere(square(0.5, kBefore), VisiblePart::kSome);
  expect_everywhere(square(2.0, kBefore), VisiblePart::kNothing);
}

TEST(NearMiss, InTheSourcesPlaneOrOneUlpBeyondItNothingIsHidden) {
  expect_everywhere(square(0.5, 1.0), VisiblePart::kAll);
  expect_everywhere(square(0.5, kAfter), VisiblePart::kAll);
}

// A triangle beside the shaft, with its tip at the middle of a side of the source.
Corners pointing_at_the_side(double tip) { return {{tip, 0, 1}, {2, -1, 0.95}, {2, 1, 0.95}}; }

TEST(NearMiss, ATipOneUlpInsideTheShaftHides) { expect_everywhere(pointing_at_the_side(kBefore), VisiblePart::kSome); }

TEST(NearMiss, ATipOnTheShaftOrOneUlpOutsideHidesNothing) {
  expect_everywhere(pointing_at_the_side(1.0), VisiblePart::kAll);
  expect_everywhere(pointing_at_the_side(kAfter), VisiblePart::kAll);
}

// An occluder that reaches all sides of the source hides everything; one that is a unit too short does not.
TEST(NearMiss, ASideOneUlpShortLeavesAGap) {
  const auto cover = [](double side) {
    return Corners{{-1, -1, kBefore}, {side, -1, kBefore}, {side, 1, kBefore}, {-1, 1, kBefore}};
  };
  PlainScene scene = scene_with(cover(1.0), {0, 0, -1});
  EXPECT_EQ(validation::solve(scene).status, Status::kZero);
  scene = scene_with(cover(1.0 - 0x1p-51), {0, 0, -1});
  for (const Engine engine : validation::kEngines) {
    EXPECT_EQ(validation::solve_by(engine, scene).planes.at(0).outcome, Outcome::kPartlyHidden) << to_string(engine);
  }
}

}  // namespace
}  // namespace exactff
