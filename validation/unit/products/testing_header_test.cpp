// The assertions that the library installs, made to fail.
#include "support/test.h"

#include <gtest/gtest-spi.h>

#include "exactff/testing.h"

namespace exactff {
namespace {

FormFactor certified(double value) {
  FormFactor f;
  f.value = value;
  f.lower = std::nextafter(value, 0.0);
  f.upper = std::nextafter(value, 1.0);
  f.status = Status::kCertified;
  return f;
}

TEST(FormFactorNear, TakesFormFactorsRowsAndNumbers) {
  EXPECT_FORM_FACTOR_NEAR(0.25, certified(0.25), 0.0);
  EXPECT_FORM_FACTOR_NEAR(0.2500001, certified(0.25), 1e-6);
  EXPECT_FORM_FACTOR_NEAR(0.26, 0.25, 0.011);
  EXPECT_FORM_FACTOR_NEAR(0.2600, 0.25, check::relative(0.041));
  EXPECT_FORM_FACTOR_NEAR(0.26, 0.25, check::Tolerance{1e-9, 0.041});
  check::TruthRow row;
  row.value = 0.25;
  ASSERT_FORM_FACTOR_NEAR(0.25, row, 0.0);
}

// The statement in EXPECT_NONFATAL_FAILURE may contain commas, but cannot use local variables.
TEST(FormFactorNear, TellsBothValuesTheErrorAndTheStatus) {
  const FormFactor f = certified(0.25);
  const double mine = std::nextafter(0.25, 1.0);
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTOR_NEAR(mine, f, 1e-20), "mine is not near f:");
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTOR_NEAR(mine, f, 1e-20), "actual    0.25000000000000006");
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTOR_NEAR(mine, f, 1e-20),
                          "expected  0.25 in [0.24999999999999997, 0.25000000000000006], certified");
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTOR_NEAR(mine, f, 1e-20),
                          "error     5.551115123125783e-17, relative 2.220446049250313e-16, 1 ulp");
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTOR_NEAR(0.5, 0.25, check::relative(0.5)), "tolerance relative 0.5");
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTOR_NEAR(std::nan(""), 0.25, 1.0), "not a finite number");
}

TEST(FormFactorNear, EndsTheTestIfAsserted) {
  EXPECT_FATAL_FAILURE(ASSERT_FORM_FACTOR_NEAR(0.5, 0.25, 0.1), "0.5 is not near 0.25");
}

class FormFactorsNear : public ::testing::Test {
 protected:
  TemporaryDirectory directory_;
  std::string file_ = directory_
                          .write("truth.csv",
                                 "receiver,x,y,z,nx,ny,nz,source,exact\n"
                                 "a,0.5,0,0,0,0,2,light,0.5\nb,0.25,0,0,0,0,2,lamp,0.25\n")
                          .string();
};

double first_coordinate(const Vec3& point, const Vec3& /*normal*/) { return point.x; }

TEST_F(FormFactorsNear, CallsTheFunctionForEveryRow) {
  const check::Truth truth = check::read_truth(file_);
  EXPECT_FORM_FACTORS_NEAR(file_, first_coordinate, check::Criteria{.max_abs = 0.0, .max_rel = 0.0});
  EXPECT_FORM_FACTORS_NEAR(truth, first_coordinate, check::Criteria{.max_abs = 0.0});
  const auto by_row = [](const check::TruthRow& row) { return row.value; };
  EXPECT_FORM_FACTORS_NEAR(truth, by_row, check::Criteria{.max_abs = 0.0});
  const auto by_source = [](const Vec3& /*point*/, const Vec3& normal, const std::string& source) {
    return normal.z == 2.0 && source == "light" ? 0.5 : 0.25;
  };
  ASSERT_FORM_FACTORS_NEAR(truth, by_source, check::Criteria{.max_abs = 0.0});
}

TEST_F(FormFactorsNear, TellsLimitsAndWorstRows) {
  const auto biased = [](const Vec3& point, const Vec3& /*normal*/) { return point.x + 0.125; };
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTORS_NEAR(file_, biased, check::Criteria{.max_abs = 0.1}),
                          "max-abs: 0.125 is above the limit 0.1, worst at receiver 'a', source 'light'");
  EXPECT_NONFATAL_FAILURE(EXPECT_FORM_FACTORS_NEAR(file_, biased, check::Criteria{.max_rel = 0.3}),
                          "receiver 'b', source 'lamp': exact 0.25, found 0.375, error 0.125, relative 0.5");
}

}  // namespace
}  // namespace exactff
