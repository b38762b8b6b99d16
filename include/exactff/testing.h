// GoogleTest assertions on form factors. Include it in tests that link GoogleTest; the library itself does not.
//
//   EXPECT_FORM_FACTOR_NEAR(my_form_factor(x, n), exactff::exact_form_factor(scene, {x, n}, light), 1e-6);
//   EXPECT_FORM_FACTOR_NEAR(mine, row, exactff::check::relative(1e-3));
//   EXPECT_FORM_FACTORS_NEAR("truth.csv", my_form_factor, exactff::check::Criteria{.max_abs = 1e-3, .rms = 1e-4});
//
// The last one calls the function for every row of a truth file and reports the limits that are exceeded and the worst
// rows. The function takes (point, normal), (point, normal, name of the source) or (row), and returns a number.
//
// Normals of truth files have any length: those of receivers on a face are as long as its area. They are exact, and a
// unit vector would be rounded. A function that needs a unit vector must divide by the length.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

inline ::testing::AssertionResult form_factor_near(const char* actual_text, const char* expected_text,
                                                   const char* /*tolerance_text*/, double actual,
                                                   const Expected& expected, const Tolerance& tolerance) {
  if (is_near(actual, expected, tolerance)) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << actual_text << " is not near " << expected_text << ":\n"
                                       << describe_difference(actual, expected, tolerance);
}

template <class Function>
double call_for_row(const Function& function, const Truth& truth, const TruthRow& row) {
  if constexpr (std::is_invocable_v<const Function&, const TruthRow&>) {
    return static_cast<double>(function(row));
  } else if constexpr (std::is_invocable_v<const Function&, const Vec3&, const Vec3&>) {
    return static_cast<double>(function(row.point, row.normal));
  } else {
    return static_cast<double>(function(row.point, row.normal, truth.source_of(row)));
  }
}

template <class Function>
::testing::AssertionResult form_factors_near(const char* truth_text, const char* function_text,
                                             const char* /*criteria_text*/, const Truth& truth,
                                             const Function& function, const Criteria& criteria) {
  if (!std::is_invocable_v<const Function&, const TruthRow&> && !(truth.has_points && truth.has_normals)) {
    return ::testing::AssertionFailure() << truth_text << " has no coordinates to call " << function_text << " with";
  }
  std::vector<double> values;
  values.reserve(truth.rows.size());
  for (const TruthRow& row : truth.rows) values.push_back(call_for_row(function, truth, row));
  const Report report = judge(truth, values, criteria);
  if (report.passed()) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << function_text << " is not near " << truth_text << ":\n"
                                       << failure_message(report);
}

template <class Function>
::testing::AssertionResult form_factors_near(const char* truth_text, const char* function_text,
                                             const char* criteria_text, const std::filesystem::path& file,
                                             const Function& function, const Criteria& criteria) {
  try {
    return form_factors_near(truth_text, function_text, criteria_text, read_truth(file), function, criteria);
  } catch (const InputError& error) {
    return ::testing::AssertionFailure() << error.what();
  }
}

}  // namespace exactff::check

// The tolerance and the criteria are the last argument, so that they may contain commas.
#define EXPECT_FORM_FACTOR_NEAR(actual, expected, ...) \
  EXPECT_PRED_FORMAT3(::exactff::check::form_factor_near, actual, expected, (__VA_ARGS__))
#define ASSERT_FORM_FACTOR_NEAR(actual, expected, ...) \
  ASSERT_PRED_FORMAT3(::exactff::check::form_factor_near, actual, expected, (__VA_ARGS__))
#define EXPECT_FORM_FACTORS_NEAR(truth, function, ...) \
  EXPECT_PRED_FORMAT3(::exactff::check::form_factors_near, truth, function, (__VA_ARGS__))
#define ASSERT_FORM_FACTORS_NEAR(truth, function, ...) \
  ASSERT_PRED_FORMAT3(::exactff::check::form_factors_near, truth, function, (__VA_ARGS__))
