// Area sampling uniform in solid angle: right on average, with the slope of theory, in scenes that formulas for
// spherical polygons do not survive.
#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace exactff::validation
