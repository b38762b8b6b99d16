// Corners in double-double: differences of vertices, and exact directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contour/quick_contour.h"
#include "generate/random.h"
#include "support/random_scenes.h"
#include "unit/solver/quick_contour_support.h"

namespace exactff::contour {
namespace {

using generate::Random;
using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;

TEST(QuickCorner, IsTheExactDifference) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(validation::seed_of(seed));
    const Vec3 p = random_vector(random, std::exp2(random.between(-40, 40)));
    const Vec3 q = random_vector(random, std::exp2(random.between(-40, 40)));
    const int exponent = static_cast<int>(random.below(200)) - 100;
    const QuickCorner corner = quick_corner(p, q, exponent);
    EXPECT_EQ(corner.error, 0.0);
    const std::array<double, 3> from = {q.x, q.y, q.z};
    const std::array<double, 3> to = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
      const Rational difference = kernel::to_rational(to[i]) - kernel::to_rational(from[i]);
      EXPECT_EQ(exactly(corner.hi[i], corner.lo[i]), kernel::times_power_of_two(difference, exponent)) << seed;
    }
  }
}

TEST(QuickCorner, TheErrorCoversWhatUnderflows) {
  for (const int exponent : {-900, -960, -1000, -1010, -1074, -1500}) {
    const Vec3 p{1.0 / 3, 1e-200, 3};
    const Vec3 q{1e-17, 0, 1e-9};
    const QuickCorner corner = quick_corner(p, q, exponent);
    EXPECT_GT(corner.error, 0.0);
    EXPECT_LT(corner.error, 0x1p-900);
    const std::array<double, 3> from = {q.x, q.y, q.z};
    const std::array<double, 3> to = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
      const Rational difference = kernel::to_rational(to[i]) - kernel::to_rational(from[i]);
      const Rational lost = kernel::times_power_of_two(difference, exponent) - exactly(corner.hi[i], corner.lo[i]);
      EXPECT_LE(abs(lost), kernel::to_rational(corner.error)) << exponent;
    }
  }
}

TEST(QuickCorner, IsNoNumberWhereItOverflows) {
  EXPECT_TRUE(std::isnan(quick_corner({1.5e308, 0, 0}, {-1.5e308, 0, 0}, -100).hi[0]));
  EXPECT_TRUE(std::isnan(quick_corner({0, 1, 0}, {}, 1024).hi[1]));
  EXPECT_TRUE(std::isnan(quick_corner({0, 0, 1}, {}, 5000).hi[2]));
  EXPECT_EQ(quick_corner({0, 5e-324, 0}, {}, 1074).hi[1], 1.0);
}

TEST(QuickCorner, OfAnExactDirectionKeepsItsErrorBound) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(validation::seed_of(seed));
    ExactVec3 direction = random_direction(random, 1 + static_cast<int>(random.below(600)));
    direction.y >>= static_cast<mp_bitcnt_t>(random.below(120));
    if (is_zero(direction)) continue;
    const QuickCorner corner = quick_corner(direction);
    const long bits = bit_length(direction);
    EXPECT_TRUE(bits > 106 || corner.error == 0.0) << seed;
    EXPECT_LE(corner.error, 0x1p-105);
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
      const Rational lost =
          kernel::times_power_of_two(Rational(direction[i]), -bits) - exactly(corner.hi[i], corner.lo[i]);
      EXPECT_LE(abs(lost), kernel::to_rational(corner.error)) << seed;
      EXPECT_EQ(corner.hi[i], corner.hi[i] + corner.lo[i]);
      largest = std::max(largest, std::abs(corner.hi[i]));
    }
    EXPECT_GE(largest, 0.5);
    EXPECT_LE(largest, 1.0);  // 1 - 2^-60 rounds to 1
  }
}

TEST(QuickCorner, OfAFewBitsIsExact) {
  const QuickCorner corner = quick_corner(ExactVec3{3, -5, (Integer(1) << 100) + 1});
  EXPECT_EQ(corner.error, 0.0);
  EXPECT_EQ(corner.hi[2], 0.5);
  EXPECT_EQ(corner.lo[2], 0x1p-101);
  EXPECT_EQ(corner.hi[1], -5 * 0x1p-101);
}

}  // namespace
}  // namespace exactff::contour
