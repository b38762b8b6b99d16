// The exact method step by step: the outcome, the candidates, and which faces hide something.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "support/solve.h"

namespace exactff {
namespace {

using generate::PlainScene;
using Corners = std::vector<Vec3>;

// Source [-1,1]^2 at z = 1 facing down, receiver at the origin facing up.
PlainScene scene_with(const std::vector<Corners>& occluders) {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}});
  for (std::size_t i = 0; i < occluders.size(); ++i) {
    scene.add_ring(scene.patch("o" + std::to_string(i + 1)), occluders[i]);
  }
  return scene;
}

Corners square(double half, double z, double x = 0.0, double y = 0.0) {
  return {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}};
}

PlaneRecord record_by(Engine engine, const PlainScene& scene) {
  return validation::solve_by(engine, scene).planes.at(0);
}
double value_of(const PlainScene& scene) { return validation::solve(scene).value; }

// Runs the test for each engine and names the engine in a failure.
template <class Check>
void for_each_engine(const PlainScene& scene, const Check& check) {
  for (const Engine engine : validation::kEngines) {
    const PlaneRecord record = record_by(engine, scene);
    SCOPED_TRACE(to_string(engine));
    EXPECT_EQ(record.engine, engine);
    check(record);
  }
}

void expect_outcome(const PlainScene& scene, Outcome expected) {
  for_each_engine(scene, [&](const PlaneRecord& record) { EXPECT_EQ(to_string(record.outcome), to_string(expected)); });
}
double open_value() { return value_of(scene_with({})); }

TEST(VisibleBoundary, ReachesEveryOutcome) {
  expect_outcome(scene_with({}), Outcome::kUnoccluded);
  expect_outcome(scene_with({square(0.25, 0.5)}), Outcome::kPartlyHidden);
  expect_outcome(scene_with({square(0.5, 0.5)}), Outcome::kHiddenByOne);
  expect_outcome(scene_with({square(0.5, 0.5, -0.25), square(0.5, 0.5, 0.25)}), Outcome::kHiddenByUnion);
  PlainScene behind = scene_with({});
  behind.point.z = 2.0;
  expect_outcome(behind, Outcome::kBehind);
  behind.point.z = 1.0;  // in the plane
  expect_outcome(behind, Outcome::kBehind);
  PlainScene below = scene_with({});
  below.normal.z = -1.0;
  expect_outcome(below, Outcome::kBelowHorizon);
}

TEST(VisibleBoundary, TheReceiversOwnFaceNeitherOccludesNorIlluminates) {
  const PlainScene plain = scene_with({square(0.25, 0.5)});
  const Scene scene = generate::build(plain);
  Receiver receiver = generate::receiver_of(plain);
  const ExactSource source(scene, scene.select("source"));
  receiver.on = {scene.faces_of(scene.select("o1")).front()};
  for (const Engine engine : validation::kEngines) {
    EXPECT_EQ(exact_form_factor(scene, receiver, source, {.engine = engine}).value, open_value()) << to_string(engine);
  }
  receiver.on = {scene.faces_of(scene.select("source")).front()};
  for (const Engine engine : validation::kEngines) {
    const FormFactor result = exact_form_factor(scene, receiver, source, {.engine = engine});
    EXPECT_EQ(result.status, Status::kZero) << to_string(engine);
    EXPECT_EQ(result.planes.at(0).outcome, Outcome::kReceiverFace) << to_string(engine);
  }
}

TEST(VisibleBoundary, FacesSeenEdgeOnOrBeyondOrInTheSourcesPlaneHideNothing) {
  const Corners edge_on = {{-0.3, 0, 0.2}, {0.4, 0, 0.2}, {0.4, 0, 0.9}, {-0.3, 0, 0.9}};
  const Corners through_x = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 0.9}, {-1, 0, 0.9}};
  const Corners coplanar = square(0.5, 1.0);
  const Corners farther = square(0.5, std::nextafter(1.0, 2.0));
  const Corners behind_x = square(5.0, -0.5);
  for (const Corners& harmless : {edge_on, through_x, coplanar, farther, behind_x}) {
    EXPECT_EQ(value_of(scene_with({harmless})), open_value());
    for_each_engine(scene_with({harmless}), [](const PlaneRecord& record) { EXPECT_EQ(record.candidates, 0U); });
  }
}

TEST(VisibleBoundary, AFaceThroughTheSourcesPlaneHidesWithItsNearPartOnly) {
  // A vertical wall at x = 0.5 from z = 0.5 up through the source: its part below z = 1 shades x > 0.5.
  const Corners wall = {{0.5, -4, 0.5}, {0.5, 4, 0.5}, {0.5, 4, 3}, {0.5, -4, 3}};
  const PlainScene scene = scene_with({wall});
  PlainScene half = scene_with({});
  half.patches.clear();
  half.add_ring(half.patch("source"), {{-1, 1, 1}, {0.5, 1, 1}, {0.5, -1, 1}, {-1, -1, 1}});
  EXPECT_EQ(value_of(scene), value_of(half));
  for_each_engine(scene, [](const PlaneRecord& record) { EXPECT_EQ(record.clipped, 1U); });
}

TEST(VisibleBoundary, OccludersThatMeetInAnEdgeHideAllTogether) {
  const Corners left = {{-0.5, -0.5, 0.5}, {0, -0.5, 0.5}, {0, 0.5, 0.5}, {-0.5, 0.5, 0.5}};
  const Corners right = {{0, -0.5, 0.5}, {0.5, -0.5, 0.5}, {0.5, 0.5, 0.5}, {0, 0.5, 0.5}};
  const Corners longer = {{0, -0.75, 0.5}, {0.5, -0.75, 0.5}, {0.5, 0.75, 0.5}, {0, 0.75, 0.5}};
  for (const Corners& other : {right, longer}) {
    expect_outcome(scene_with({left, other}), Outcome::kHiddenByUnion);
    EXPECT_EQ(validation::solve(scene_with({left, other})).status, Status::kZero);
  }
}

// The first face of the source is covered, the second is not.
TEST(VisibleBoundary, WhatHidesOneFaceOfTheSourceDoesNotHideTheOther) {
  PlainScene two = scene_with({});
  two.patches.clear();  // apart, or they would be one panel
  two.add_ring(two.patch("source"), {{-1, 1, 1}, {0, 1, 1}, {0, -1, 1}, {-1, -1, 1}});
  two.add_ring(two.patch("source"), {{0.25, 1, 1}, {1, 1, 1}, {1, -1, 1}, {0.25, -1, 1}});
  two.add_ring(two.patch("o1"), {{-0.5, -0.5, 0.5}, {0, -0.5, 0.5}, {0, 0.5, 0.5}, {-0.5, 0.5, 0.5}});
  PlainScene right = scene_with({});
  right.patches.clear();
  right.add_ring(right.patch("source"), {{0.25, 1, 1}, {1, 1, 1}, {1, -1, 1}, {0.25, -1, 1}});
  expect_outcome(two, Outcome::kPartlyHidden);
  EXPECT_EQ(value_of(two), value_of(right));
}

TEST(VisibleBoundary, OtherFacesOfTheSourceOccludeIt) {
  PlainScene plain = scene_with({});
  plain.add_ring(plain.patch("source"), square(0.25, 0.5));  // faces up, away from x: contributes nothing
  EXPECT_EQ(value_of(plain), value_of(scene_with({square(0.25, 0.5)})));
}

TEST(VisibleBoundary, ADiscWithHorizonThroughItKeepsTheUpperPart) {
  PlainScene plain = scene_with({});
  plain.normal = {1, 0, 0};
  for (const Engine engine : validation::kEngines) {
    const FormFactor result = validation::solve_by(engine, plain, {.exact_fraction = true});
    EXPECT_TRUE(result.planes[0].horizon_clipped) << to_string(engine);
    EXPECT_EQ(result.planes[0].exact_fraction, "1/2") << to_string(engine);
    EXPECT_EQ(result.visible_fraction, 0.5) << to_string(engine);
  }
}

TEST(VisibleBoundary, StagesTellWhatWasLeftOut) {
  const auto ran_by = [](Engine engine, const PlainScene& scene, const std::string& stage) {
    for (const StageNote& note : stages(record_by(engine, scene))) {
      if (note.stage == stage) return note.ran;
    }
    ADD_FAILURE() << "no stage " << stage;
    return false;
  };
  const PlainScene open = scene_with({});
  const PlainScene cut = scene_with({square(0.25, 0.5)});
  const PlainScene hidden = scene_with({square(0.5, 0.5)});
  for (const Engine engine : validation::kEngines) {
    SCOPED_TRACE(to_string(engine));
    const auto ran = [&](const PlainScene& scene, const std::string& stage) { return ran_by(engine, scene, stage); };
    const std::string work = engine == Engine::kEdges ? "edges" : "projection and Booleans";
    EXPECT_FALSE(ran(open, work));
    EXPECT_TRUE(ran(open, "contour"));
    EXPECT_TRUE(ran(cut, work));
    EXPECT_FALSE(ran(cut, "horizon clip"));
    EXPECT_FALSE(ran(hidden, work));
    EXPECT_FALSE(ran(hidden, "contour"));
    EXPECT_TRUE(ran(hidden, "total occlusion"));
  }
}

// More than are compared one by one, and in another order than the input's.
TEST(VisibleBoundary, NoneOfManyOccludersIsLost) {
  constexpr int kSide = 64;
  std::vector<Corners> many;
  for (int i = 0; i < kSide * kSide; ++i) {
    many.push_back(square(0.25 / kSide, 0.5, (i % kSide + 0.5) / kSide - 0.5, (i / kSide + 0.5) / kSide - 0.5));
  }
  const FormFactor result = validation::solve_by(Engine::kEdges, scene_with(many), {.exact_fraction = true});
  EXPECT_EQ(result.planes.at(0).exact_fraction, "3/4");
  EXPECT_EQ(result.planes.at(0).edges, std::size_t{4 + 4 * kSide * kSide});
}

}  // namespace
}  // namespace exactff
