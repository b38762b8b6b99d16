// The exact method step by step: the outcome, the candidates, and which faces hide something.
#include <stdexcept>

#include "support/solve.h"
#include "support/test.h"
#include "visibility/source_plane.h"

namespace exactff {
namespace {

using validation::solve;
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

// --- What is seen of a source, as a value: it gives what separate searches give, in every bit ---

const Receiver kReceiver{.point = {0.3, 0.1, 0.0}, .normal = {0.1, 0.2, 1.0}, .on = {}, .id = {}};

Scene soup() { return models::make_scene("soup:n=60,floor=0"); }

void expect_same(const FormFactor& a, const FormFactor& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.visible_fraction, b.visible_fraction);
  EXPECT_EQ(a.planes.size(), b.planes.size());
}

TEST(VisibleRegion, GivesAllMeasuresOfOneSearch) {
  const Scene scene = soup();
  const ExactSource source(scene, scene.select("source"));
  for (const Engine engine : {Engine::kEdges, Engine::kBoolean}) {
    VisibleRegion region(scene, kReceiver, source, {.engine = engine, .visible_fraction = true});
    EXPECT_FALSE(region.empty());
    for (const Measure& measure : {Measure{}, Measure{.kind = MeasureKind::kSolidAngle},
                                   Measure{.kind = MeasureKind::kOvercast, .up = {0.3, 0.1, 1.0}}, Measure{}}) {
      const FormFactor alone =
          exact_form_factor(scene, kReceiver, source, {.engine = engine, .measure = measure, .visible_fraction = true});
      expect_same(region.form_factor(measure), alone);
    }
    EXPECT_THROW((void)region.form_factor({.sphere = true}), std::invalid_argument);
  }
}

TEST(VisibleRegion, GivesTheGradientOfTheSameArcs) {
  const Scene scene = soup();
  const ExactSource source(scene, scene.select("source"));
  const ExactOptions options{.gradient = true, .vertices = true};
  const FormFactor alone = exact_form_factor(scene, kReceiver, source, options);
  VisibleRegion first(scene, kReceiver, source);
  VisibleRegion region = std::move(first);
  const double value = region.form_factor().value;
  const Gradient gradient = region.gradient(options);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(gradient.position[axis].value, alone.gradient->position[axis].value);
    EXPECT_EQ(gradient.normal[axis].value, alone.gradient->normal[axis].value);
  }
  ASSERT_EQ(gradient.vertices.size(), alone.gradient->vertices.size());
  for (std::size_t v = 0; v < gradient.vertices.size(); ++v) {
    EXPECT_EQ(gradient.vertices[v].vertex, alone.gradient->vertices[v].vertex);
    EXPECT_EQ(gradient.vertices[v].position[2].value, alone.gradient->vertices[v].position[2].value);
  }
  EXPECT_EQ(region.form_factor().value, value);
  EXPECT_THROW((void)first.empty(), std::logic_error);
}

TEST(VisibleRegion, OfASphereGivesMeasuresOfSpheresAlone) {
  const Scene scene = soup();
  const ExactSource source(scene, scene.select("source"));
  const ExactOptions options{.measure = {.kind = MeasureKind::kSolidAngle, .sphere = true}};
  VisibleRegion region(scene, kReceiver, source, options);
  expect_same(region.form_factor(options.measure), exact_form_factor(scene, kReceiver, source, options));
  EXPECT_THROW((void)region.form_factor(), std::invalid_argument);
  EXPECT_THROW((void)region.gradient(), std::invalid_argument);
  EXPECT_THROW(region.find(scene, kReceiver, source, {.engine = Engine::kBoth}), std::invalid_argument);
}

// As seen from x, arcs end where others begin.
TEST(VisibleRegion, HasArcsOnTheirLinesInSpace) {
  const Scene scene = soup();
  const ExactSource source(scene, scene.select("source"));
  const VisibleRegion region(scene, kReceiver, source);
  const auto arcs = region.arcs();
  ASSERT_GT(arcs.size(), 4U);
  std::size_t before_the_source = 0;
  for (const RegionArc& arc : arcs) {
    const double height = scene.vertices()[scene.face(scene.faces_of(scene.select("source")).front()).rings[0][0]].z;
    EXPECT_LE(arc.from.z, height * (1.0 + 1e-12));
    before_the_source += arc.from.z < 0.999 * height ? 1 : 0;
    const auto meets = [&](const RegionArc& other) {
      const Vec3 &x = kReceiver.point, &p = arc.to, &q = other.from;
      const double a = (p.x - x.x) / (p.z - x.z) - (q.x - x.x) / (q.z - x.z);
      const double b = (p.y - x.y) / (p.z - x.z) - (q.y - x.y) / (q.z - x.z);
      return std::abs(a) + std::abs(b) < 1e-12;
    };
    EXPECT_TRUE(std::ranges::any_of(arcs, meets));
  }
  EXPECT_GT(before_the_source, 0U);
}

// --- sources with several faces, or with a hole ---

// A rectangle at height z that faces down.
Corners rectangle(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y1, z}, {x1, y1, z}, {x1, y0, z}, {x0, y0, z}};
}

PlainScene source_of(const std::vector<Corners>& faces) {
  PlainScene scene;
  for (const Corners& face : faces) scene.add_ring(scene.patch("source"), face);
  return scene;
}

Enclosure form_factor(const Corners& face) { return solve(source_of({face})).enclosure; }

// Two balls of about 90 bits, or sums of such balls, that contain the same number.
void expect_equal(const Enclosure& a, const Enclosure& b) {
  EXPECT_TRUE(a.overlaps(b)) << a.midpoint() << " and " << b.midpoint();
  EXPECT_LT(a.upper() - a.lower(), 0x1p-50);
  EXPECT_LT(b.upper() - b.lower(), 0x1p-50);
}

TEST(SourcePlane, StepsInParallelPlanesCountEachForItself) {
  const Corners low = rectangle(-1, 0, -1, 1, 1);
  const Corners high = rectangle(0, 1, -1, 1, 2);
  const PlainScene plain = source_of({low, high});
  const Scene scene = generate::build(plain);
  EXPECT_EQ(visibility::group_by_plane(scene, scene.faces_of(scene.select("source"))).size(), 2U);
  Enclosure sum = form_factor(low);
  sum += form_factor(high);
  expect_equal(solve(plain).enclosure, sum);
}

TEST(SourcePlane, AnOverlapCountsOnceInTheVisibleFraction) {
  PlainScene plain = source_of({rectangle(-1, 0.5, -1, 1, 1), rectangle(-0.5, 1, -1, 1, 1)});
  EXPECT_EQ(solve(plain, {.visible_fraction = true}).visible_part, VisiblePart::kAll);
  plain.add_ring(plain.patch("right_half"), rectangle(0, 1, -1, 1, 0.5));
  EXPECT_EQ(solve(plain, {.visible_fraction = true}).visible_fraction, 0.5);
}

TEST(SourcePlane, AHoleGivesNothing) {
  const Corners inner = rectangle(-0.5, 0.25, -0.5, 0.75, 1);
  PlainScene framed;
  framed.add_rings(framed.patch("source"), {rectangle(-1, 1, -1, 1, 1), inner});
  Enclosure sum = solve(framed).enclosure;
  sum += form_factor(inner);
  expect_equal(sum, form_factor(rectangle(-1, 1, -1, 1, 1)));
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
