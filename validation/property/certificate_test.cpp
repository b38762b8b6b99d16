// The proof that comes with a value: enclosures at every precision, and the rounding of visible fractions.
#include <gmpxx.h>

#include "support/decimal.h"
#include "support/solve.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

// Each precision cap ends the loop with a different ball; all balls contain the same F, and so do the bounds.
TEST(Certificate, BallsAndBoundsOfEveryPrecisionHoldTheFormFactor) {
  for (std::uint64_t i = 0; i < scaled_count(40); ++i) {
    Random random(seed_of(i));
    const PlainScene plain = random_scene(random);
    const Scene scene = generate::build(plain);
    const FormFactor fine = solve(scene, plain, {.digits = 60});
    if (fine.status == Status::kZero) continue;
    const Decimal exact = read_decimal(fine.enclosure.decimals(60).value());
    for (int bits = 4; bits <= 108; bits += 2) {
      for (const Engine engine : kEngines) {
        const FormFactor coarse = solve_by(engine, scene, plain, {.precision_cap = bits});
        const std::string where = std::string(to_string(engine)) + " with " + std::to_string(bits) + " bits, seed " +
                                  std::to_string(seed_of(i)) + '\n' + generate::to_obj(plain);
        ASSERT_TRUE(coarse.enclosure.overlaps(fine.enclosure)) << where;
        ASSERT_LE(mpq_class(coarse.lower), exact.value + exact.half_unit) << where;
        ASSERT_GE(mpq_class(coarse.upper), exact.value - exact.half_unit) << where;
        if (coarse.status != Status::kCertified) continue;
        ASSERT_EQ(coarse.value, fine.value) << where;
      }
    }
  }
}

// A triangle of size 2^-shrink above a tilted receiver: about `shrink` bits cancel in the contour.
PlainScene shrunk_source(Random& random, int shrink) {
  const auto corner = [&] {
    const double x = std::ldexp(random.between(-1.0, 1.0), -shrink);
    return Vec3{x, std::ldexp(random.between(-1.0, 1.0), -shrink), 1.0};
  };
  std::vector<Vec3> corners{corner(), corner(), corner()};
  const Vec3 u{corners[1].x - corners[0].x, corners[1].y - corners[0].y, 0};
  const Vec3 v{corners[2].x - corners[0].x, corners[2].y - corners[0].y, 0};
  if (u.x * v.y - u.y * v.x > 0) std::swap(corners[1], corners[2]);  // faces down
  PlainScene scene;
  scene.normal = {random.between(0.5, 1.0), random.between(0.5, 1.0), random.between(0.5, 1.0)};
  scene.add_ring(scene.patch("source"), corners);
  return scene;
}

// For every loss of precision, some first ball contains the midpoint of two doubles; certifying either double would be
// wrong half of the time.
TEST(Certificate, AValueStaysWhenMoreDecimalsAreAskedFor) {
  bool raised = false;
  for (std::uint64_t i = 0; i < scaled_count(1200); ++i) {
    Random random(seed_of(i));
    const int shrink = static_cast<int>(i % 60);
    const PlainScene plain = shrunk_source(random, shrink);
    const FormFactor plainly = solve(plain);
    const FormFactor closely = solve(plain, {.digits = 60});
    ASSERT_EQ(plainly.value, closely.value) << "2^-" << shrink << ", seed " << seed_of(i);
    ASSERT_EQ(plainly.status, closely.status) << "2^-" << shrink << ", seed " << seed_of(i);
    if (plainly.status == Status::kZero) continue;  // corners on one line: nothing to integrate
    ASSERT_LT(plainly.precision_bits, closely.precision_bits);
    raised = raised || plainly.precision_bits > 96;
  }
  EXPECT_TRUE(raised) << "no source was small enough";
}

bool mantissa_is_even(double value) { return (std::bit_cast<std::uint64_t>(value) & 1U) == 0; }

// No double is nearer, and a tie goes to the even one. The test compares only rationals.
bool is_nearest(double value, const mpq_class& exact) {
  const mpq_class error = abs(mpq_class(value) - exact);
  for (const double toward : {-1.0, 2.0}) {
    const mpq_class other = abs(mpq_class(std::nextafter(value, toward)) - exact);
    if (other < error || (other == error && !mantissa_is_even(value))) return false;
  }
  return true;
}

TEST(Certificate, AVisibleFractionIsTheDoubleNearestToTheExactOne) {
  int inexact = 0;
  for (std::uint64_t i = 0; i < scaled_count(100); ++i) {
    Random random(seed_of(i));
    const PlainScene plain = random_scene(random);
    const FormFactor result = solve(plain, {.visible_fraction = true, .exact_fraction = true});
    for (const PlaneRecord& plane : result.planes) {
      const mpq_class exact(plane.exact_fraction.value());
      if (exact != mpq_class(exact.get_d())) ++inexact;
      ASSERT_TRUE(is_nearest(plane.visible_fraction.value(), exact))
          << generate::to_text(*plane.visible_fraction) << " for " << *plane.exact_fraction << ", seed " << seed_of(i)
          << '\n'
          << generate::to_obj(plain);
    }
    if (result.planes.size() != 1) continue;
    ASSERT_EQ(result.visible_fraction, result.planes[0].visible_fraction) << "seed " << seed_of(i);
  }
  EXPECT_GT(inexact, 10) << "fractions that are doubles prove nothing";
}

}  // namespace
}  // namespace exactff::validation
