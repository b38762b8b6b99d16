// Sentences about a report.
#pragma once

#include <string>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

[[nodiscard]] std::string name_of(const Quantile& quantile);  // "quantile 0.99"
[[nodiscard]] std::string name_of(const Verdict& verdict);    // "max-abs, source light"
// "max-abs, source light: 0.0123 is above the limit 0.01, worst at receiver '7'"
[[nodiscard]] std::string sentence(const Verdict& verdict);
// "receiver '7', source 'light'"
[[nodiscard]] std::string name_of(const RowError& row);
// "row 'floor', column 'light'"
[[nodiscard]] std::string name_of_entry(const std::string& from, const std::string& to);
// "exact 0.25, found 0.26, error 0.01, relative 0.04"
[[nodiscard]] std::string describe(const RowError& row);
// What the user should know about the result, whether it passed or not.
[[nodiscard]] std::vector<std::string> warnings(const Report& report);

}  // namespace exactff::check
