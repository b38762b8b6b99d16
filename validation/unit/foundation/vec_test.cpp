// Unit vectors of all sizes.
#include "kernel/vec.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "generate/random.h"

namespace exactff::kernel {
namespace {

using generate::Random;

// --- Vectors of all sizes, and with components of very different ones ---

double any_component(Random& random) {
  if (random.one_in(8)) return random.one_in(2) ? 0.0 : -0.0;
  const double fraction = random.between(1.0, 2.0) * (random.one_in(2) ? -1.0 : 1.0);
  return std::ldexp(fraction, random.integer(-1074, 1023));
}
Vec3 near_one_size(Random& random) {
  const int exponent = random.integer(-1074, 1020);
  const auto component = [&] { return std::ldexp(random.between(-1.0, 1.0), exponent); };
  return {component(), component(), component()};
}

void for_each_vector(const std::function<void(const Vec3&)>& visit) {
  using Limits = std::numeric_limits<double>;
  const std::vector<double> extremes = {
      0.0,     -0.0,    1.0,           -1.0,          0x1p-538, Limits::min(), -Limits::denorm_min(),
      0x1p511, 0x1p512, Limits::max(), -Limits::max()};
  for (const double x : extremes) {
    for (const double y : extremes) {
      for (const double z : extremes) visit({x, y, z});
    }
  }
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    visit(near_one_size(random));
    visit({any_component(random), any_component(random), any_component(random)});
  }
}

void expect_same_bits(const Vec3& a, const Vec3& b, const Vec3& of) {
  for (const auto c : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a.*c), std::bit_cast<std::uint64_t>(b.*c))
        << a.*c << " and " << b.*c << " of " << of.x << ", " << of.y << ", " << of.z;
  }
}

TEST(UnitVectors, HaveLengthOneAndZeroStaysZero) {
  for_each_vector([](const Vec3& v) {
    if (max_norm(v) == 0.0) {
      expect_same_bits(unit(v), v, v);
      expect_same_bits(unit_by_inverse(v), v, v);
      return;
    }
    ASSERT_NEAR(length(unit(v)), 1.0, 0x1p-51);
    ASSERT_NEAR(length(unit_by_inverse(v)), 1.0, 0x1p-51);
  });
}

}  // namespace
}  // namespace exactff::kernel
