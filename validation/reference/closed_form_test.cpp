// Form factors from a point with known closed forms, to the last bit. The constants are correct to 30 digits, and
// strtod rounds correctly. The digits come from the catalogue's formulas, evaluated to 60 digits:
//   parallel, below a corner (B-3): (X/A atan(Y/A) + Y/B atan(X/B)) / 2 pi, A = sqrt(1+X^2), B = sqrt(1+Y^2),
//   perpendicular (B-4), all sides 1: (atan 1 - atan(1/sqrt 2) / sqrt 2) / 2 pi;
// a centred plate at half the height hides a centred square of twice its side: the difference of two such sums.
#include <cstdlib>

#include "support/decimal.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

// The square [low,high]^2 at height z, facing down.
void add_square(PlainScene& scene, const char* patch, double low, double high, double z) {
  scene.add_ring(scene.patch(patch), {{low, high, z}, {high, high, z}, {high, low, z}, {low, low, z}});
}

void expect_digits(const PlainScene& plain, const char* digits) {
  const Scene scene = generate::build(plain);
  ExactOptions options;
  options.engine = Engine::kBoth;
  options.digits = 30;
  const FormFactor result =
      exact_form_factor(scene, generate::receiver_of(plain), ExactSource(scene, scene.select(plain.source)), options);
  EXPECT_EQ(result.status, Status::kCertified);
  EXPECT_EQ(result.value, std::strtod(digits, nullptr));
  EXPECT_EQ(read_decimal(result.enclosure.decimals(30).value()).value, read_decimal(digits).value);
}

TEST(ClosedForm, ParallelUnitSquareBelowACorner) {
  PlainScene scene;
  add_square(scene, "source", 0, 1, 1);
  expect_digits(scene, "0.138531605994892996780769708634");
}

TEST(ClosedForm, ParallelUnitSquareBelowTheCentre) {
  PlainScene scene;
  add_square(scene, "source", -0.5, 0.5, 1);
  expect_digits(scene, "0.239456470460773538825052152012");
}

TEST(ClosedForm, PerpendicularUnitSquare) {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}});
  expect_digits(scene, "0.0557341970025535016096151456828");
}

TEST(ClosedForm, SquareBehindASquarePlate) {
  PlainScene scene;
  add_square(scene, "source", -1, 1, 1);
  add_square(scene, "occ", -0.25, 0.25, 0.5);
  expect_digits(scene, "0.314669953518798448298026682526");
}

TEST(ClosedForm, SquareBehindASmallerSquarePlate) {
  PlainScene scene;
  add_square(scene, "source", -1, 1, 1);
  add_square(scene, "occ", -0.125, 0.125, 0.5);
  expect_digits(scene, "0.480648789167050624563809780375");
}

}  // namespace
}  // namespace exactff::validation
