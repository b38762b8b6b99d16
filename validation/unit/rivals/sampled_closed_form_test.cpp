#include <gtest/gtest.h>

#include "adaptive/sub_patch.h"

namespace exactff::adaptive {
namespace {

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

}  // namespace
}  // namespace exactff::adaptive
