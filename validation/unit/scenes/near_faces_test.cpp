// Receivers that are given by coordinates, and the faces that they were meant for.
#include <gtest/gtest.h>

#include <cmath>

#include "exactff/exact.h"
#include "exactff/receiver.h"

namespace exactff {
namespace {

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

TEST(NearFaces, APointAHairBehindItsFloorIsFound) {
  const Scene scene = room();
  const Receiver receiver{{1.5, 0.75, -3e-7}, {0, 0, 1}, {}, ""};
  const NearFaces near = find_faces(scene, receiver, face_tolerance(scene, receiver.point));
  EXPECT_EQ(near.faces, std::vector{FaceId{0}});
  EXPECT_EQ(near.side, -1);
  EXPECT_NEAR(near.distance, 3e-7, 1e-12);
  EXPECT_FALSE(near.turned);
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

// --- What is told ---------------------------------------------------------------------------------------

TEST(NearMisses, AreCountedAndTheFirstAreNamed) {
  const Scene scene = room();
  std::vector<Receiver> receivers = {{{1, 2, -3e-7}, {0, 0, 1}, {}, "a"},
                                     {{1, 2, 0}, {0, 0, 1}, {}, "b"},
                                     {{1, 2, 2e-7}, {0, 0, 1}, {}, "c"},
                                     {{1, 2, 1}, {0, 0, 1}, {}, "d"},
                                     {{1, 2, 0}, {0, 0, -1}, {FaceId{1}}, "e"}};
  const NearMisses misses = near_misses(scene, receivers);
  EXPECT_EQ(misses.behind, 1U);
  EXPECT_EQ(misses.in_front, 1U);
  EXPECT_EQ(misses.turned, 1U);
  const auto told = sentences(misses, receivers.size());
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0],
            "2 of 5 receivers are given without a face, within 3e-07 of one; 1 of them look through it from behind, so "
            "it hides everything; --on auto places them on their faces");
  EXPECT_EQ(told[2],
            "the first: 'a', 3e-07 behind 'floor:2'; 'c', 2e-07 in front of 'floor:2'; 'e', turned against "
            "'floor:2'");
  EXPECT_TRUE(sentences(near_misses(scene, std::span(receivers).subspan(1, 1)), 1).empty());
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
