// One unit in the last place decides: an occluder hides if it is that much nearer than the source or inside the shaft,
// and hides nothing on the limit or beyond it. The receivers' coordinates make every difference round.
#include "support/solve.h"
#include "support/test.h"

namespace exactff {
namespace {

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

// --- Receivers that are given by coordinates, and the faces that they were meant for ---

// A room of two patches, `floor` at z = 0 (two triangles) and `light` at z = 2.
Scene room(double tilt = 0.0) {
  const double c = std::cos(tilt), s = std::sin(tilt);
  const auto at = [&](double x, double y, double z) {
    const auto round = [&](double t) { return tilt == 0.0 ? t : std::round(t * 1e6) / 1e6; };
    return Vec3{round(c * x - s * z), round(y), round(s * x + c * z)};
  };
  SceneBuilder builder("test");
  for (const Vec3& v :
       {at(0, 0, 0), at(4, 0, 0), at(4, 3, 0), at(0, 3, 0), at(1, 1, 2), at(1, 2, 2), at(3, 2, 2), at(3, 1, 2)}) {
    builder.add_vertex(v);
  }
  const MaterialId grey = builder.add_material({"grey", {0.5, 0.5, 0.5}, {}});
  builder.add_face(builder.patch("floor"), grey, {{0, 1, 2}});
  builder.add_face(builder.patch("floor"), grey, {{0, 2, 3}});
  builder.add_face(builder.patch("light"), grey, {{4, 5, 6, 7}});
  return builder.build();
}

TEST(NearFaces, TheSideIsExact) {
  const Scene scene = room();
  const auto side = [&](double z) { return find_faces(scene, {{1.5, 0.75, z}, {0, 0, 1}, {}, ""}, 1e-6).side; };
  EXPECT_EQ(side(-1e-300), -1);
  EXPECT_EQ(side(0.0), 0);
  EXPECT_EQ(side(1e-300), 1);
}

TEST(NearFaces, NormalsMustAgreeWithinADegreeEitherWay) {
  const Scene scene = room();
  const auto find = [&](const Vec3& normal) { return find_faces(scene, {{1, 2, 0}, normal, {}, ""}, 1e-6); };
  EXPECT_FALSE(find({0, 0.017, 1}).faces.empty());
  EXPECT_TRUE(find({0, 0.018, 1}).faces.empty());
  EXPECT_TRUE(find({0, 0, -1e-300}).turned);
  EXPECT_EQ(find({0, 0, -1e-300}).faces, std::vector{FaceId{1}});
}

TEST(NearFaces, TheToleranceFollowsThePrintedDecimals) {
  const Scene scene = room();  // its diameter is 5.4
  EXPECT_NEAR(face_tolerance(scene, {1, 2, 0}), 5.4e-6, 1e-7);
  EXPECT_EQ(face_tolerance(scene, {1.25, 2, 0.0001}), 1e-4);
  EXPECT_NEAR(face_tolerance(scene, {1.5, 2, 0}), 5.4e-3, 1e-4);  // not more than 1e-3 of the diameter
}

TEST(OwnFaces, AreNamedAndReadBack) {
  const Scene scene = room();
  const std::vector both = {FaceId{0}, FaceId{1}};
  EXPECT_EQ(scene.name_of(both), "floor:1+2");
  EXPECT_EQ(own_faces_named(scene, "floor:1+2"), both);
  EXPECT_EQ(own_faces_named(scene, "floor:2"), std::vector{FaceId{1}});
  EXPECT_EQ(own_faces_named(scene, "light"), std::vector{FaceId{2}});
  for (const char* wrong : {"floor", "floor:1+3", "floor:1+x", "floor:1+", "sky:1+2", "floor:+1"}) {
    EXPECT_THROW((void)own_faces_named(scene, wrong), InputError) << wrong;
  }
}

}  // namespace
}  // namespace exactff
