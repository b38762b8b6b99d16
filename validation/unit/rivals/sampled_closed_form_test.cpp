#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "adaptive/sub_patch.h"

namespace exactff::adaptive {
namespace {

constexpr double kUnderCentre = 0.239456470460773538825052152012;

SubPatch square(double h, double z) {
  const std::vector<Vec3> corners = {{-h, -h, z}, {-h, h, z}, {h, h, z}, {h, -h, z}};
  return make_sub_patch(corners);
}

// Four edges, each with a handful of roundings and an atan2 within 1 ulp: 32 ulp is generous for well-placed patches.
constexpr double kBound = 32 * 0x1p-53;

TEST(ClosedForm, ParallelRectangleBelowACorner) {
  const std::vector<Vec3> corners = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  const double truth = 0.138531605994892996780769708634;
  EXPECT_NEAR(unoccluded_form_factor(make_sub_patch(corners), {0, 0, 1}), truth, kBound * truth);
}

TEST(ClosedForm, SquareOverItsCentre) {
  EXPECT_NEAR(unoccluded_form_factor(square(0.5, 1.0), {0, 0, 1}), kUnderCentre, kBound * kUnderCentre);
}

TEST(ClosedForm, PerpendicularRectangle) {
  const std::vector<Vec3> wall = {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
  const double truth = 0.0557341970025535016096151456828;
  EXPECT_NEAR(unoccluded_form_factor(make_sub_patch(wall), {0, 0, 1}), truth, kBound * truth);
}

// Below h/r = 1/8 the series replaces atan2; on both sides F must be the same function.
TEST(ClosedForm, SeriesAndArcTangentAgree) {
  for (double h = 1.0; h > 1e-3; h *= 0.93) {
    const SubPatch whole = square(h, 4.0);
    double parts = 0.0;
    for (const SubPatch& part : split_patch(whole)) parts += unoccluded_form_factor(part, {0, 0, 1});
    const double f = unoccluded_form_factor(whole, {0, 0, 1});
    // Splitting adds edges through the middle, which cancel: relative loss about r/h.
    EXPECT_NEAR(parts, f, kBound * f * (4.0 / h)) << h;
  }
}

// facts.md's square of side h at (100, 37, 50): relative loss about r/h and no worse.
TEST(ClosedForm, LosesNoMoreThanTheDistanceOverTheSize) {
  for (const double h : {1.0, 1e-2, 1e-4}) {
    const std::vector<Vec3> corners = {{100, 37, 50}, {100, 37 + h, 50}, {100 + h, 37 + h, 50}, {100 + h, 37, 50}};
    const Vec3 centre{100 + h / 2, 37 + h / 2, 50};
    const double squared = dot(centre, centre);
    const double small_patch_limit = h * h * 2500.0 / (std::numbers::pi * squared * squared);
    const double distance = std::sqrt(squared);
    EXPECT_NEAR(unoccluded_form_factor(make_sub_patch(corners), {0, 0, 1}) / small_patch_limit, 1.0,
                h * h / squared + 4e-16 * distance / h * distance / h)
        << h;
  }
}

TEST(ClosedForm, LiteralIsBlindAtADistance) {
  const double far = unoccluded_form_factor(square(0.5, 1000.0), {0, 0, 1});
  EXPECT_NEAR(far, 1.0 / (std::numbers::pi * 1e6), 1e-12);
  const double literal = literal_unoccluded_form_factor(square(0.5, 1000.0), {0, 0, 1});
  EXPECT_GT(std::abs(literal / far - 1.0), 0.05);
  EXPECT_EQ(literal_unoccluded_form_factor(square(0.5, 1e4), {0, 0, 1}), 0.0);
}

TEST(ClosedForm, LiteralIsRightNearby) {
  EXPECT_NEAR(literal_unoccluded_form_factor(square(0.5, 1.0), {0, 0, 1}), kUnderCentre, 1e-6);
}

}  // namespace
}  // namespace exactff::adaptive
