#include <exactff/exact.h>
#include <exactff/scene_files.h>
#include <exactff/testing.h>
#include <gtest/gtest-spi.h>

#include <string>

#include "form_factor.h"

namespace {

const std::string kTruth = GUARD_FOLDER "/truth.csv";

double sampled(const exactff::Vec3& point, const exactff::Vec3& /*normal*/) {
  return sampled_form_factor({point.x, point.y, point.z});
}

// At any point that a test thinks of.
TEST(SampledFormFactor, IsRightBeneathThePlate) {
  const exactff::Scene scene = exactff::read_obj(GUARD_FOLDER "/room.obj");
  const exactff::ExactSource lamp(scene, scene.select("lamp"));
  const exactff::Receiver receiver{
      .point = {2, 1.5, 0}, .normal = {0, 0, 1}, .on = {*scene.select("floor:1").face}, .id = {}};
  EXPECT_FORM_FACTOR_NEAR(sampled(receiver.point, receiver.normal), exactff::exact_form_factor(scene, receiver, lamp),
                          1e-4);
}

// Over a whole truth file.
TEST(SampledFormFactor, IsRightAllOverTheFloor) {
  EXPECT_FORM_FACTORS_NEAR(kTruth, sampled, exactff::check::Criteria{.max_abs = 3e-4, .rms = 1e-4});
}

TEST(SampledFormFactor, WouldBeCaughtWithABugOfAThousandth) {
  const auto wrong = [](const exactff::Vec3& point, const exactff::Vec3& normal) {
    return sampled(point, normal) + 1e-3;
  };
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTORS_NEAR(kTruth, wrong, exactff::check::Criteria{.max_abs = 3e-4}),
                          "is above the limit");
}

}  // namespace
