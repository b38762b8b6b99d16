// Statistics of errors, and numbers and durations as tables and reports write them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kernel/statistics.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::study {
namespace {

// --- statistics --------------------------------------------------------------------------------------

TEST(Statistics, OfErrorsAgreeWithHandValues) {
  const std::vector<double> errors = {3, -4, 0, 0};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.rms, 2.5);
  EXPECT_EQ(s.mean, -0.25);
  EXPECT_EQ(s.p99, 4);
  EXPECT_EQ(s.worst, 4);
  EXPECT_EQ(s.not_a_number, 0U);
}

TEST(Statistics, WhatIsNoNumberIsCountedApart) {
  const std::vector<double> errors = {1, std::numeric_limits<double>::quiet_NaN(), -1};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.not_a_number, 1U);
  EXPECT_EQ(s.rms, 1);
}

TEST(Statistics, TheRmsOfTinyErrorsDoesNotUnderflow) {
  const std::vector<double> errors = {3e-200, 4e-200};
  EXPECT_NEAR(error_statistics(errors).rms / 1e-200, std::sqrt(12.5), 1e-15 * 10);
}

// The literal variant of Nettle's method has such errors in scenes of 1e76.
TEST(Statistics, ErrorsNearTheLargestDoubleDoNotOverflow) {
  const std::vector<double> errors = {0x1p1023, 0x1p1023, 0x1.8p1023, -0x1.8p1023};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.mean, 0x1p1022);
  EXPECT_EQ(s.worst, 0x1.8p1023);
  EXPECT_LE(s.rms, s.worst);
  EXPECT_EQ(kernel::median(errors), 0x1p1023);
  EXPECT_TRUE(std::isfinite(kernel::mean_half_width(errors)));
  EXPECT_NEAR(kernel::mean_half_width(std::vector{0x1p600, -0x1p600}) / kernel::mean_half_width(std::vector{1.0, -1.0}),
              0x1p600, 0x1p550);
}

TEST(Statistics, PercentilesAreOfTheNearestRank) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(kernel::nearest_rank(values, 0.99), 99);
  EXPECT_EQ(kernel::nearest_rank(values, 1), 100);
  EXPECT_EQ(kernel::nearest_rank(values, 0.005), 1);
  values.push_back(101);
  EXPECT_EQ(kernel::nearest_rank(values, 0.99), 100);  // ceil(99.99)
  EXPECT_EQ(kernel::nearest_rank({7}, 0.99), 7);
}

TEST(Statistics, TheMedianOfAnEvenCountIsTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(kernel::median({5, 1, 3}), 3);
  EXPECT_EQ(kernel::median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(kernel::median({}), 0);
}

TEST(Statistics, TheSlopeOfAPowerLawIsItsExponent) {
  const std::vector<std::pair<double, double>> points = {{1, 8}, {4, 4}, {16, 2}, {0, 9}};
  EXPECT_NEAR(kernel::fitted_slope(points).value(), -0.5, 1e-12);
  const std::vector<std::pair<double, double>> one = {{1, 8}, {1, 4}};
  EXPECT_FALSE(kernel::fitted_slope(one).has_value());
}

// --- words and numbers -------------------------------------------------------------------------------

TEST(Text, ASharedPartIsNeverRoundedToNoneOrAll) {
  EXPECT_EQ(text::share(0, 10), "0 %");
  EXPECT_EQ(text::share(1, 100000), "under 0.1 %");
  EXPECT_EQ(text::share(99999, 100000), "over 99.9 %");
  EXPECT_EQ(text::share(1, 3), "33.3 %");
  EXPECT_EQ(text::share(3, 3), "100 %");
}

TEST(Text, DurationsTakeTheUnitThatFits) {
  EXPECT_EQ(text::duration(3.12e-7), "312 ns");
  EXPECT_EQ(text::duration(4.512e-6), "4.51 µs");
  EXPECT_EQ(text::duration(0.0012), "1.2 ms");
  EXPECT_EQ(text::duration(125), "2 min 5 s");
}

}  // namespace
}  // namespace exactff::study
