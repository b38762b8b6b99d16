// A printed enclosure, read back exactly, contains the enclosure.
#include "kernel/ball.h"
#include "support/decimal.h"
#include "support/solve.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

// Midpoints of any size with few or many bits, radii from far above to far below them; sometimes either is 0.
struct Sample {
  Ball ball;
  mpq_class middle;
  mpq_class radius;
};

mpq_class with_exponent(long mantissa, int exponent) {
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 2, static_cast<unsigned long>(std::abs(exponent)));
  return exponent < 0 ? mpq_class(mantissa, power) : mpq_class(mantissa * power);
}

Sample sample(Random& random) {
  const long middle = random.one_in(8) ? 0 : random.integer(1, random.one_in(2) ? 9 : (1 << 30));
  const int exponent = random.integer(-1500, 10);
  const long radius = random.one_in(8) ? 0 : random.integer(1, 1 << 20);
  const int radius_exponent = exponent + random.integer(-600, 40);
  Sample out;
  arf_set_si_2exp_si(arb_midref(out.ball.get()), middle, exponent);
  mag_set_ui_2exp_si(arb_radref(out.ball.get()), static_cast<ulong>(radius), radius_exponent);
  out.middle = with_exponent(middle, exponent);
  out.radius = with_exponent(radius, radius_exponent);
  out.middle.canonicalize();
  out.radius.canonicalize();
  return out;
}

TEST(PrintedBall, HoldsTheBall) {
  int around_zero = 0;
  for (std::uint64_t i = 0; i < scaled_count(2000); ++i) {
    Random random(seed_of(i));
    const Sample original = sample(random);
    const Enclosure enclosure = EnclosureInside::of(original.ball);
    const mpq_class middle = read_decimal(enclosure.midpoint()).value;
    const mpq_class radius = read_decimal(enclosure.radius()).value;
    ASSERT_LE(abs(middle - original.middle) + original.radius, radius) << "seed " << seed_of(i);
    const mpq_class width = original.radius == 0 ? abs(original.middle) / 10000 : original.radius;
    ASSERT_LE(radius, 3 * width) << "seed " << seed_of(i);
    around_zero += original.middle == 0 && radius > 0 ? 1 : 0;
  }
  EXPECT_GT(around_zero, 0);  // a contour that cancels completely gives such balls
}

// At the precision that is sufficient to know that F rounds to 0, its terms have cancelled to a ball around 0. Such a
// ball was once printed as nan with the radius 0.
TEST(PrintedBall, HoldsAFormFactorWhoseTermsCancel) {
  generate::PlainScene scene;
  scene.add_ring(
      scene.patch("source"),
      {{-0x1p-200, 0x1p+202, -0x1.8p-199}, {-0x1p-200, 0x1p+200, 0x1.cp-198}, {-0x1.4p-198, -0x1.8p+201, 0x1p-197}});
  scene.point = {-0x1p-200, -0x1p+202, 0};
  const FormFactor result = solve(scene);
  EXPECT_EQ(result.status, Status::kUnderflow);
  const mpq_class middle = read_decimal(result.enclosure.midpoint()).value;
  const mpq_class radius = read_decimal(result.enclosure.radius()).value;
  const Decimal form_factor = read_decimal("1.97506008171372843679196044289e-361");
  EXPECT_LE(abs(form_factor.value - middle), radius + form_factor.half_unit);
  EXPECT_LT(radius, read_decimal("5e-324").value);
}

}  // namespace
}  // namespace exactff::validation
