// The baseline works as a ratchet: the statistics recorded in a file are the limits of later checks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

// Default slack: far above the noise that rounding adds to an error, far below the effect of any change of a method.
inline constexpr double kDefaultSlack = 1e-9;

// A statistic that is better than the baseline by more than the slack.
struct Improvement {
  std::string criterion;
  std::string source;
  double recorded = 0.0;
  double now = 0.0;
};

// The statistics of the report as JSON, for a baseline file.
[[nodiscard]] std::string baseline_text(const Report& report);

// Whether these errors may become a baseline: no value is not a number, and nothing got worse than the baseline that
// the report was held against. So the ratchet never loosens.
[[nodiscard]] bool may_be_recorded(const Report& report);

// Adds to the report a verdict on every statistic of the baseline, and returns the improvements. A statistic is worse
// if it exceeds the recorded one by more than the share `slack` of it and also by more than 4 units in the last place
// of the largest truth, because different compilers do not agree more closely. Throws InputError if the file cannot be
// read, or if it was recorded with other rows, other truths or another relative floor.
std::vector<Improvement> hold_against_baseline(Report& report, const std::filesystem::path& baseline,
                                               double slack = kDefaultSlack);

}  // namespace exactff::check
