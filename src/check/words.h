// Texts that several outputs of a check use.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

// `digits` significant digits in plain characters, suitable as the value of a flag: "0.0123", "1.2e-07".
[[nodiscard]] std::string short_number(double value, int digits = 3);
[[nodiscard]] std::string name_of(const Quantile& quantile);  // "quantile 0.99"
[[nodiscard]] std::string name_of(const Verdict& verdict);    // "max-abs, source light"
// "max-abs, source light: 0.0123 is above the limit 0.01, at receiver '7'"
[[nodiscard]] std::string sentence(const Verdict& verdict);
// "receiver '7', source 'light'"
[[nodiscard]] std::string name_of(const RowError& row);
// "exact 0.25, found 0.26, error 0.01, relative 0.04"
[[nodiscard]] std::string describe(const RowError& row);
// What the user should know about the result, whether it passed or not.
[[nodiscard]] std::vector<std::string> warnings(const Report& report);

}  // namespace exactff::check
