// Crossings with the source's plane: the double-double result is always right, or it declines. EXACTFF_TEST_SCALE
// multiplies the number of segments.
#include "support/test.h"
#include "visibility/source_plane.h"

namespace exactff::visibility {
namespace {

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

}  // namespace
}  // namespace exactff::visibility
