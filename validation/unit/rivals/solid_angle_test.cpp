// Area sampling uniform in solid angle: right on average, with the slope of theory, in scenes that formulas for
// spherical polygons do not survive.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "methods/area_sampling.h"
#include "unit/rivals/methods_support.h"
#include "unit/rivals/moments.h"

namespace exactff::validation {
namespace {

using generate::PlainScene;

const std::string kBySolidAngle = "area-sampling:measure=solid-angle";

PlainScene scene_of(const std::vector<Vec3>& source, const Vec3& normal = {0, 0, 1}) {
  PlainScene plain;
  add(plain, "source", source);
  plain.normal = normal;
  return plain;
}

PlainScene half_hidden(PlainScene plain) {
  add(plain, "occluder", {{-2, -2, 0.5}, {-2, 2, 0.5}, {0.11, 2, 0.5}, {0.23, -2, 0.5}});
  return plain;
}

struct Family {
  const char* name;
  PlainScene scene;
};

// A rectangle and a triangle in each.
std::vector<Family> families() {
  const auto rectangle = [](double x, double y, double z, double a, double b) {
    return std::vector<Vec3>{{x, y, z}, {x, y + b, z}, {x + a, y + b, z}, {x + a, y, z}};
  };
  const auto triangle = [](double x, double y, double z, double a, double b) {
    return std::vector<Vec3>{{x, y, z}, {x, y + b, z}, {x + a, y, z}};
  };
  return {{"plain", scene_of(rectangle(-1, -1, 1, 2, 2))},
          {"plain triangle", scene_of(triangle(-1, -1, 1, 2, 2))},
          {"tiny", scene_of(rectangle(0.3, 0.2, 1, 1e-9, 1e-9))},
          {"tiny triangle", scene_of(triangle(0.3, 0.2, 1, 1e-9, 1e-9))},
          {"far", scene_of(rectangle(0.3, 0.2, 1e7, 1, 2))},
          {"long", scene_of({{1, -1e4, 0}, {1, -1e4, 2}, {1, 1e4, 2}, {1, 1e4, 0}})},
          {"sliver", scene_of(triangle(0.3, -1e4, 1, 1e-6, 2e4))},
          {"x almost in the plane", scene_of(rectangle(1, -1, 1e-9, 1, 2), {1, 0, 0})},
          {"x almost in the plane of a triangle", scene_of(triangle(1, -1, 1e-9, 1, 2), {1, 0, 0})},
          {"x almost on the source", scene_of(rectangle(-1, -1, 1e-9, 2, 3), {0.6, 0, 0.8})},
          {"x almost on a triangle", scene_of(triangle(-1, -1, 1e-9, 3, 5), {0.6, 0, 0.8})},
          {"x almost on a side", scene_of(rectangle(1e-9, -1, 1e-9, 2, 3), {0.6, 0, 0.8})},
          {"x below a corner", scene_of(rectangle(0, 0, 1e-6, 2, 3))},
          {"grazing at the horizon", scene_of({{-1, -1, 1e-9}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 1e-9}})},
          {"across the horizon", scene_of({{1, -1, -1}, {1, -1, 2}, {1, 1, 2}, {1, 1, -1}})},
          {"across the horizon, oblique", scene_of(rectangle(-1, -1, 1, 2, 2), {0.8, 0.3, 0.1})},
          {"quadrilateral", scene_of({{-1, -1, 1}, {-1, 1, 1}, {1, 1.5, 1}, {0.5, -1, 1}})}};
}

TEST(SolidAngle, OfDegenerateSourcesIsRightOnAverage) {
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    const double f = truth(family.scene);
    ASSERT_GT(f, 0.0);
    for (const char* pattern : {"random", "stratified", "sobol"}) {
      const std::vector<double> values =
          values_by_seed(family.scene, kBySolidAngle + ",samples=64,pattern=" + pattern, 64);
      for (const double value : values) EXPECT_TRUE(value >= 0.0 && value <= 2.0) << value;
      const Moments found = moments(values);
      EXPECT_NEAR(found.mean / f, 1.0, 5.0 * std::sqrt(found.variance / 64.0) / f + 1e-7) << pattern;
    }
  }
}

// The kernel is a cosine, which is as smooth near the source as far from it.
TEST(SolidAngle, HasALittleVarianceWhereAreaHasMuch) {
  const PlainScene near = scene_of({{-1, -1, 0.01}, {-1, 1, 0.01}, {1, 1, 0.01}, {1, -1, 0.01}}, {0.6, 0, 0.8});
  const double by_area = moments(values_by_seed(near, "area-sampling", 64)).variance;
  EXPECT_LT(moments(values_by_seed(near, kBySolidAngle, 64)).variance, 0.01 * by_area);
}

// As for AreaSampling.VarianceFallsAsTheoryHasIt.
TEST(SolidAngle, VarianceFallsAsTheoryHasIt) {
  const double slack = std::exp(5.0 * std::sqrt(4.0 / 63.0));
  const auto ratio = [](const PlainScene& plain, const std::string& pattern) {
    const auto variance = [&](const char* samples) {
      return moments(values_by_seed(plain, kBySolidAngle + ",pattern=" + pattern + ",samples=" + samples, 64)).variance;
    };
    return variance("16") / variance("256");
  };
  const PlainScene triangle = scene_of({{-1, -1, 1}, {-1, 1.5, 1}, {1.5, -1, 1}});
  for (const PlainScene& plain : {open_scene(), triangle}) {
    EXPECT_LT(std::abs(std::log(ratio(half_hidden(plain), "random") / 16.0)), std::log(slack));
    EXPECT_LT(std::abs(std::log(ratio(half_hidden(plain), "stratified") / 64.0)), std::log(slack));
    EXPECT_GT(ratio(plain, "stratified"), 256.0 / slack);
    EXPECT_GT(ratio(plain, "sobol"), 256.0 / slack);
  }
}

TEST(SolidAngle, IsSharedOutOverAllFaces) {
  PlainScene plain;
  add(plain, "source", {{-1, -1, 1}, {-1, 1, 1}, {1, 1.5, 1}, {0.5, -1, 1}});
  add(plain, "source", {{2, 0, 2}, {2, 1, 2}, {3, 0, 2}});
  add(plain, "source", {{-2, -1, -1}, {-2, 1, -1}, {-2, 1, 2}, {-2, 0, 3}, {-2, -1, 2}});
  const double f = truth(plain);
  for (const char* pattern : {"random", "stratified", "sobol"}) {
    const Moments found = moments(values_by_seed(plain, kBySolidAngle + ",pattern=" + pattern, 64));
    EXPECT_NEAR(found.mean, f, 5.0 * std::sqrt(found.variance / 64.0)) << pattern;
  }
}

TEST(SolidAngle, BehindManyOccludersIsRightOnAverage) {
  const PlainScene plain = generate::soup({.n = 600, .seed = 8});
  const Moments found = moments(values_by_seed(plain, kBySolidAngle + ",pattern=stratified", 64));
  EXPECT_NEAR(found.mean, truth(plain), 5.0 * std::sqrt(found.variance / 64.0));
}

TEST(SolidAngle, OfARectangleIsThatOfItsTriangles) {
  using methods::SolidAnglePart;
  const std::vector<Vec3> square = {{-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}, {1, -1, 1}};
  std::vector<SolidAnglePart> parts;
  methods::add_solid_angle_parts(square, 1.0, parts);
  ASSERT_EQ(parts.size(), 1U);
  const double triangles = SolidAnglePart::triangle(square[0], square[1], square[2], 1.0).solid_angle() +
                           SolidAnglePart::triangle(square[0], square[2], square[3], 1.0).solid_angle();
  EXPECT_NEAR(parts.front().solid_angle(), triangles, 1e-14);
  EXPECT_NEAR(triangles, 4.0 * std::numbers::pi / 6.0, 1e-14) << "a side of a cube";
}

}  // namespace
}  // namespace exactff::validation
