// Nettle, Wallace and area sampling: properties that theory predicts.
#include "methods/area_sampling.h"
#include "support/test.h"
#include "unit/rivals/methods_support.h"
#include "unit/rivals/moments.h"

namespace exactff::validation {
namespace {

PlainScene half_hidden() {
  PlainScene plain = open_scene();
  add(plain, "occluder", {{-2, -2, 0.5}, {-2, 2, 0.5}, {0.11, 2, 0.5}, {0.23, -2, 0.5}});
  return plain;
}

// The midpoint rule on cells of side h errs by at most A h^2 / 24 (max |f_uu| + max |f_vv|); for 1/(pi (1 + r^2)^2)
// both are at most 4 / pi.
double midpoint_bound(double area, double h) { return area * h * h / 24.0 * 8.0 * std::numbers::inv_pi; }

TEST(Nettle, SplitIntoCellsItIsTheMidpointRule) {
  const PlainScene plain = open_scene();
  const double f = truth(plain);
  for (const int m : {1, 4, 16, 64}) {
    const double found = value(plain, "nettle:splits=" + std::to_string(m));
    EXPECT_NEAR(found, f, midpoint_bound(4.0, 2.0 / m)) << m;
  }
  EXPECT_NEAR(value(plain, "nettle"), 4.0 * std::numbers::inv_pi, 1e-14);  // A / (pi r^2): more than 1
}

TEST(Wallace, SplitIntoDiscsItConvergesWithTheirArea) {
  const PlainScene plain = open_scene();
  const double f = truth(plain);
  for (const int m : {1, 4, 16, 64}) {
    const double area = 4.0 / (m * m);
    const double found = value(plain, "wallace:splits=" + std::to_string(m));
    // The disc reduces each term by at most dA / (pi r^2), and r is at least 1.
    EXPECT_NEAR(found, f, midpoint_bound(4.0, 2.0 / m) + (f + midpoint_bound(4.0, 2.0 / m)) * area / std::numbers::pi);
  }
  EXPECT_NEAR(value(plain, "wallace:splits=1"), 4.0 / (std::numbers::pi + 4.0), 1e-14);
}

TEST(Nettle, TheLiteralVariantShinesBehindAndScalesByARatioOfAreas) {
  PlainScene behind = open_scene();
  behind.point = {0, 0, 2};
  behind.normal = {0, 0, -1};
  EXPECT_EQ(value(behind, "nettle"), 0.0);
  const double inverse = 1.0 / (4.0 * std::numbers::pi);  // 1/(pi r^2) times 1 over the source's area
  EXPECT_NEAR(value(behind, "nettle:variant=literal"), inverse, 1e-15);
  EXPECT_NEAR(value(behind, "nettle:variant=literal,receiver_area=3"), 3.0 * inverse, 1e-15);
  EXPECT_NEAR(value(behind, "nettle:variant=literal,area_ratio=sender-over-receiver,receiver_area=8"),
              0.5 * std::numbers::inv_pi, 1e-15);
  PlainScene below = open_scene();
  below.normal = {0, 0, -1};
  EXPECT_NEAR(value(below, "nettle:variant=literal"), inverse, 1e-15);
  add(behind, "lid", {{-2, -2, 1.5}, {2, -2, 1.5}, {2, 2, 1.5}, {-2, 2, 1.5}});
  EXPECT_EQ(value(behind, "nettle:variant=literal"), 0.0);  // faces in between hide the source, also from behind
}

// 64 independent batches: their mean is within 5 of its standard errors.
TEST(StochasticMethods, AreRightOnAverage) {
  for (const PlainScene& plain : {half_hidden(), open_scene(), generate::soup({.n = 60, .seed = 5})}) {
    const double f = truth(plain);
    for (const char* choice : {"area-sampling", "area-sampling:pattern=stratified", "area-sampling:pattern=sobol",
                               "area-sampling:pattern=sobol,samples=7"}) {
      const Moments found = moments(values_by_seed(plain, choice, 64));
      EXPECT_NEAR(found.mean, f, 5.0 * std::sqrt(found.variance / 64.0)) << choice;
      EXPECT_GT(found.variance, 0.0);
    }
  }
}

// Root mean square error against n: slope -1/2; -3/4 across one shadow edge; -1 without an edge. For two variances with
// 63 degrees of freedom each, the logarithm of the ratio is within 5 standard deviations, sqrt(2/63 + 2/63).
TEST(AreaSampling, VarianceFallsAsTheoryHasIt) {
  const double slack = std::exp(5.0 * std::sqrt(4.0 / 63.0));
  const auto ratio = [](const PlainScene& plain, const std::string& pattern) {
    const auto variance = [&](const char* samples) {
      return moments(values_by_seed(plain, "area-sampling:pattern=" + pattern + ",samples=" + samples, 64)).variance;
    };
    return variance("16") / variance("256");
  };
  EXPECT_LT(std::abs(std::log(ratio(half_hidden(), "random") / 16.0)), std::log(slack));
  EXPECT_LT(std::abs(std::log(ratio(half_hidden(), "stratified") / 64.0)), std::log(slack));
  EXPECT_GT(ratio(open_scene(), "stratified"), 256.0 / slack);
  EXPECT_GT(ratio(open_scene(), "sobol"), 256.0 / slack);
}

// A lamp of 2^-400 by 2^-400 at a distance of 1: squares of its area underflow.
PlainScene speck() {
  PlainScene plain = open_scene();
  for (Vec3& v : plain.vertices) v = {v.x * 0x1p-400, v.y * 0x1p-400, v.z};
  return plain;
}

TEST(RayMethods, AreRightWhereTheSquareOfAnAreaUnderflows) {
  const PlainScene plain = speck();
  const double f = truth(plain);
  ASSERT_NEAR(f * 0x1p800, 4.0 * std::numbers::inv_pi, 1e-12);
  for (const char* choice : {"area-sampling:pattern=random", "area-sampling:pattern=stratified",
                             "area-sampling:pattern=sobol", "wallace", "nettle"}) {
    EXPECT_NEAR(value(plain, choice) / f, 1.0, 1e-12) << choice;
  }
}

// The text's ratio of areas divided by a squared distance scales with the fourth power of the unit of length.
TEST(LiteralNettle, IsTheLargestDoubleWhereItsNumberIsLarger) {
  PlainScene plain = open_scene();
  const double f = value(plain, "nettle:variant=literal");
  generate::scale(plain, 0x1p-100);
  EXPECT_NEAR(value(plain, "nettle:variant=literal") / f, 0x1p400, 0x1p360);
  generate::scale(plain, 0x1p-300);
  EXPECT_EQ(value(plain, "nettle:variant=literal"), std::numeric_limits<double>::max());
  generate::scale(plain, 0x1p800);
  EXPECT_EQ(value(plain, "nettle:variant=literal"), 0.0);
}

// x is 2^-530 below a tiny lamp; a vertex that no face uses gives the scene its size.
TEST(RayMethods, AreNumbersWhereDistancesSquaredUnderflow) {
  PlainScene plain = open_scene();
  for (Vec3& v : plain.vertices) v = {v.x * 0x1p-530, v.y * 0x1p-530, v.z * 0x1p-530};
  plain.vertices.push_back({1, 1, 1});
  for (const char* choice :
       {"area-sampling", "area-sampling:pattern=sobol", "wallace", "nettle", "nettle:variant=literal",
        "nettle:variant=literal,area_ratio=sender-over-receiver", "adaptive:variant=literal"}) {
    EXPECT_TRUE(std::isfinite(value(plain, choice))) << choice;
  }
  EXPECT_NEAR(value(plain, "adaptive"), truth(plain), 1e-12);
}

}  // namespace
}  // namespace exactff::validation
