// Unit vectors: which formulas give the same bits, and which do not.
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

// --- The same formulas with another length, as they were written in several places before ---

Vec3 safe(const Vec3& a) {
  const double largest = max_norm(a);
  return {a.x / largest, a.y / largest, a.z / largest};
}
double by_hypot(const Vec3& a) { return std::hypot(a.x, a.y, a.z); }
double by_squares(const Vec3& a) { return std::sqrt((a.x * a.x + a.y * a.y) + a.z * a.z); }

template <class Length>
Vec3 with_division(const Vec3& a, const Length& length) {
  const Vec3 b = safe(a);
  const double size = length(b);
  return {b.x / size, b.y / size, b.z / size};
}
template <class Length>
Vec3 with_inverse(const Vec3& a, const Length& length) {
  const Vec3 b = safe(a);
  return scaled(b, 1.0 / length(b));
}

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

TEST(UnitVectors, HypotAndTheRootOfTheSumOfSquaresGiveTheSameBits) {
  for_each_vector([](const Vec3& v) {
    if (max_norm(v) == 0.0) return;
    expect_same_bits(unit(v), with_division(v, by_hypot), v);
    expect_same_bits(unit(v), with_division(v, by_squares), v);
    expect_same_bits(unit_by_inverse(v), with_inverse(v, by_hypot), v);
    expect_same_bits(unit_by_inverse(v), with_inverse(v, by_squares), v);
  });
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

TEST(UnitVectors, TheThreeWaysDifferInTheLastBits) {
  int by_inverse = 0, unscaled = 0;
  for_each_vector([&](const Vec3& v) {
    if (!(max_norm(v) > 0x1p-1000 && max_norm(v) < 0x1p1000)) return;
    if (unit(v) != unit_by_inverse(v)) ++by_inverse;
    if (unit_by_inverse(v) != unit_unscaled(v)) ++unscaled;
    ASSERT_LT(kernel::distance(unit(v), unit_by_inverse(v)), 0x1p-51);
    ASSERT_LT(kernel::distance(unit(v), unit_unscaled(v)), 0x1p-51);
  });
  EXPECT_GT(by_inverse, 1000) << "else one way would do";
  EXPECT_GT(unscaled, 1000) << "else one way would do";
}

}  // namespace
}  // namespace exactff::kernel
