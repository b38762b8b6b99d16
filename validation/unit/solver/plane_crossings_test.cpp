// Crossings with the source's plane: the double-double result is always right, and it declines if it cannot decide.
// EXACTFF_TEST_SCALE multiplies the number of segments.
#include <gtest/gtest.h>

#include <cmath>

#include "generate/random.h"
#include "support/random_scenes.h"
#include "visibility/source_plane.h"

namespace exactff::visibility {
namespace {

using generate::Random;
using kernel::Rational;

struct Segment {
  Vec3 x, p, q;
  Vec3 a, b, c;  // in the plane
};

Vec3 random_point(Random& random, double size) {
  return {size * random.between(-1, 1), size * random.between(-1, 1), size * random.between(-1, 1)};
}

Vec3 between(const Vec3& a, const Vec3& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

// Some segments have ends within rounding errors of the plane; some cross the plane within rounding errors of x.
Segment random_segment(Random& random) {
  const double size = std::ldexp(1.0, random.integer(-40, 40));
  Segment s{random_point(random, size), random_point(random, size), random_point(random, size),
            random_point(random, size), random_point(random, size), random_point(random, size)};
  if (random.below(3) == 0) s.p = between(between(s.a, s.b, random.between(0, 1)), s.c, random.between(0, 1));
  if (random.below(3) == 0) s.x.x = s.p.x = s.q.x;
  if (random.below(6) == 0) s.x = s.a = between(s.p, s.q, random.between(0, 1));
  return s;
}

kernel::ExactVec3 normal_of(const Segment& s) {
  const kernel::ScaledVec3 ab = kernel::exact_difference(s.b, s.a), ac = kernel::exact_difference(s.c, s.a);
  kernel::ExactVec3 normal = kernel::cross(ab.v, ac.v);
  kernel::make_primitive(normal);
  return normal;
}

int height_sign(const Segment& s, const Vec3& y) { return kernel::orientation(s.a, s.b, s.c, y); }

// The point where the segment pq crosses the plane with this normal.
void expect_holds(const PlaneCrossings::Fine& fine, PlaneCrossings& crossings, const Vec3& p, const Vec3& q,
                  const kernel::ExactVec3& normal) {
  kernel::ScaledVec3 exact;
  crossings.set_exact(exact, p, q, normal, fine.exponent);
  const Rational u = kernel::to_rational(0x1p-53);
  for (int axis = 0; axis < 3; ++axis) {
    const Rational t = kernel::times_power_of_two(Rational(exact.v[axis]), exact.exponent);
    const Rational hi = kernel::to_rational(fine.direction.hi[axis]), lo = kernel::to_rational(fine.direction.lo[axis]);
    EXPECT_LE(abs(t - hi - lo), kernel::to_rational(fine.direction.error));
    EXPECT_LE(abs(t - hi), 2 * u * abs(t));
    EXPECT_EQ(fine.direction.hi[axis] == 0.0, kernel::sign(t) == 0);
  }
}

TEST(PlaneCrossings, HoldWhatTheyPromise) {
  int fine_ones = 0, declined = 0;
  for (std::uint64_t i = 0; i < validation::scaled_count(3000); ++i) {
    Random random(validation::seed_of(i));
    const Segment s = random_segment(random);
    const kernel::ExactVec3 normal = normal_of(s);
    if (kernel::is_zero(normal) || height_sign(s, s.p) * height_sign(s, s.q) >= 0) continue;
    int scale = 0;
    std::frexp(std::abs(s.p.x - s.x.x) + std::abs(s.q.y - s.x.y) + std::abs(s.q.z - s.x.z), &scale);
    PlaneCrossings crossings;
    crossings.start(s.x, fine_normal(normal), s.a, -scale);
    const auto fine = crossings.fine(s.p, s.q);
    if (!fine) {
      ++declined;
      continue;
    }
    ++fine_ones;
    expect_holds(*fine, crossings, s.p, s.q, normal);
  }
  EXPECT_GT(fine_ones, 500);
  EXPECT_GT(declined, 20);
}

// The horizon's normal is three doubles, of any length, and its plane contains x.
TEST(PlaneCrossings, HoldWhatTheyPromiseOnTheHorizon) {
  int fine_ones = 0, fine_along_z = 0;
  for (std::uint64_t i = 0; i < validation::scaled_count(3000); ++i) {
    Random random(validation::seed_of(i));
    const Segment s = random_segment(random);
    const double length = std::ldexp(1.0, static_cast<int>(i % 1900) - 950);
    const bool along_z = i % 5 == 0;
    const Vec3 n{along_z ? 0.0 : (random.unit() - 0.5) * length, along_z ? 0.0 : (random.unit() - 0.5) * length,
                 i % 5 == 1 ? 0.0 : length};
    if (kernel::exact_sign_of_dot(n, {s.x, s.p}) * kernel::exact_sign_of_dot(n, {s.x, s.q}) >= 0) continue;
    int scale = 0;
    std::frexp(std::abs(s.p.x - s.x.x) + std::abs(s.q.y - s.x.y) + std::abs(s.q.z - s.x.z), &scale);
    PlaneCrossings crossings;
    crossings.start(s.x, fine_normal(n), s.x, -scale);
    const auto fine = crossings.fine(s.p, s.q);
    if (!fine) continue;
    ++(along_z ? fine_along_z : fine_ones);
    expect_holds(*fine, crossings, s.p, s.q, kernel::exact_vector(n).v);
  }
  EXPECT_GT(fine_ones, 300);
  EXPECT_GT(fine_along_z, 100);
}

TEST(PlaneCrossings, KnowAnExactZero) {
  const kernel::ExactVec3 normal{0, 0, 1};
  PlaneCrossings crossings;
  crossings.start({0.1, 0.3, 0}, fine_normal(normal), {5, 5, 1}, 0);
  const auto fine = crossings.fine({0.1, 0.7, 0.5}, {0.1, 0.2, 1.5});
  ASSERT_TRUE(fine);
  EXPECT_EQ(fine->direction.hi[0], 0.0);
  EXPECT_EQ(fine->direction.lo[0], 0.0);
  expect_holds(*fine, crossings, {0.1, 0.7, 0.5}, {0.1, 0.2, 1.5}, normal);
}

// If a component of 2^128 is scaled to 1, a component of 2^-900 becomes denormal.
TEST(PlaneCrossings, HoldWhatTheyPromiseOfTheSmallestComponents) {
  const kernel::ExactVec3 normal{0, 0, 1};
  constexpr double kFar = 0x1p128;
  PlaneCrossings crossings;
  crossings.start({0, 0, 0}, fine_normal(normal), {0, 0, kFar}, 0);
  int fine_ones = 0, declined = 0;
  for (int exponent = -1020; exponent < -400; ++exponent) {
    Random random(static_cast<std::uint64_t>(-exponent));
    const double y = std::ldexp(random.between(1, 2), exponent);
    const Vec3 p{1.3 * kFar, y, 1.7 * kFar}, q{1.1 * kFar, 0.7 * y, 0.3 * kFar};
    const auto fine = crossings.fine(p, q);
    ++(fine ? fine_ones : declined);
    if (fine) expect_holds(*fine, crossings, p, q, normal);
  }
  EXPECT_GT(fine_ones, 100);
  EXPECT_GT(declined, 100);
}

// If x lies on the segment's line, the crossing is within rounding errors of x.
TEST(PlaneCrossings, DeclineWhereComponentsCancel) {
  const kernel::ExactVec3 normal{0, 0, 1};
  PlaneCrossings crossings;
  const Vec3 p{0, 0, 0.5}, q{1, 1, 1.5};
  crossings.start({0.5, 0.5, 0}, fine_normal(normal), {0, 0, 1}, 0);  // straight below the crossing
  EXPECT_FALSE(crossings.fine(p, q));
}

}  // namespace
}  // namespace exactff::visibility
