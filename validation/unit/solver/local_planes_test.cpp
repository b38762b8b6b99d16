// Control variates from nearby values of a function.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactff/scene.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/vec.h"
#include "view_factors/exact_scene.h"
#include "view_factors/interim_analyses.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {
namespace {

class LocalPlanesOf : public testing::TestWithParam<std::vector<Vec3>> {
 protected:
  static Scene build() {
    generate::PlainScene plain;
    plain.add_ring(plain.patch("patch"), GetParam());
    return generate::build(plain);
  }
  // At a random place of the part.
  [[nodiscard]] Vec3 point(generate::Random& random) const {
    const std::vector<Point>& corners = parts_[0].corners;
    double s = random.unit(), t = random.unit();
    if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
    const Vec3& from = corners[0].at;
    const auto side = [&](std::size_t i) { return kernel::difference(corners[i].at, from); };
    return kernel::along(kernel::along(from, side(1), s), side(2), t);
  }

  const Scene scene_ = build();
  const ExactScene exact_{scene_};
  const std::vector<Part> parts_ = parts_of(exact_, scene_.select("patch"));
};

TEST_P(LocalPlanesOf, KnowNothingBeforeAnythingIsShown) {
  LocalPlanes planes(parts_);
  EXPECT_FALSE(planes.about(0, parts_[0].corners[0].at));
  planes.add(0, parts_[0].corners[1].at, 0.25);
  const auto plane = planes.about(0, parts_[0].corners[0].at);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->value, 0.25);
  EXPECT_EQ(kernel::length(plane->gradient), 0.0);
}

// However many values there are, and wherever.
TEST_P(LocalPlanesOf, AreALinearFunctionItself) {
  generate::Random random(5);
  const Vec3 slope{0.5, -0.25, 0.75};
  const auto f = [&](const Vec3& at) { return 0.125 + kernel::dot(slope, at); };
  LocalPlanes planes(parts_);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 at = point(random);
    planes.add(0, at, f(at));
    if (i < 20 || i % 100 != 0) continue;
    const Vec3 place = point(random), other = point(random), step = kernel::difference(other, place);
    const auto plane = planes.about(0, place);
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->value, f(place), 1e-9);
    if (kernel::length(plane->gradient) == 0.0) continue;  // of values along a line
    EXPECT_NEAR(kernel::dot(plane->gradient, step), kernel::dot(slope, step), 1e-6 * kernel::length(step) + 1e-9);
  }
}

// The more values, the nearer they are: what is left of a curved function falls as the square of their distance.
TEST_P(LocalPlanesOf, ComeCloserToACurvedFunction) {
  generate::Random random(6);
  const auto f = [](const Vec3& at) { return std::sin(7.0 * at.x + 3.0 * at.y) + at.z * at.z; };
  LocalPlanes planes(parts_);
  const auto worst = [&] {
    std::vector<double> errors;
    for (int i = 0; i < 200; ++i) {
      const Vec3 place = point(random);
      errors.push_back(std::abs(planes.about(0, place)->value - f(place)));
    }
    std::ranges::sort(errors);
    return errors[150];
  };
  const auto add = [&](int count) {
    for (int i = 0; i < count; ++i) {
      const Vec3 at = point(random);
      planes.add(0, at, f(at));
    }
  };
  add(250);
  const double before = worst();
  add(3750);
  EXPECT_LT(worst(), 0.15 * before);
}

INSTANTIATE_TEST_SUITE_P(Shapes, LocalPlanesOf,
                         testing::Values(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {2, 0, 1}, {0.5, 1, 0}},
                                         std::vector<Vec3>{
                                             {0, 0, 0}, {8, 0, 0}, {8, 0.0625, 0.0625}, {0, 0.0625, 0.0625}}));

TEST(LocalPlanes, TellPartsApart) {
  generate::PlainScene plain;
  plain.add_ring(plain.patch("patch"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("patch"), {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}});
  const Scene scene = generate::build(plain);
  const ExactScene exact(scene);
  const std::vector<Part> parts = parts_of(exact, scene.select("patch"));
  LocalPlanes planes(parts);
  for (int i = 0; i < 8; ++i) planes.add(0, parts[0].corners[0].at, 0.75);
  EXPECT_FALSE(planes.about(1, parts[1].corners[0].at));
  EXPECT_EQ(planes.about(0, parts[0].corners[2].at)->value, 0.75) << "all values are those of one point";
}

}  // namespace
}  // namespace exactff::view_factors
