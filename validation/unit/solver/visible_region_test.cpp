// What is seen of a source, as a value: it gives what separate searches give, in every bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "exactff/models.h"
#include "exactff/region.h"

namespace exactff {
namespace {

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

// The feet of the table bury parts of the floor.
TEST(VisibleRegion, BelowTheHorizonHasAGradientOfZero) {
  const Scene scene = models::make_scene("closed-room");
  const ExactSource source(scene, scene.select("floor"));
  VisibleRegion region(scene, {.point = {3.1, 1.5, 2.2}, .normal = {0.0, 1.0, 0.0}, .on = {}, .id = {}}, source);
  EXPECT_TRUE(region.empty());
  const Gradient gradient = region.gradient();
  for (const Derivative& one : gradient.position) EXPECT_EQ(one.status, DerivativeStatus::kZero);
}

}  // namespace
}  // namespace exactff
