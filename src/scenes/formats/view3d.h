// 1 - x of a decimal number, exactly: View3D files hold emittances, scenes reflectances.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace exactff::formats {

// The decimal of 1 - x for x = [+]DIGITS[.DIGITS] within [0, 1]; nothing for any other text. "0.90" gives "0.10".
[[nodiscard]] std::optional<std::string> decimal_complement(std::string_view x);

// A double within [0, 1] as the shortest decimal without exponent that reads back to it.
[[nodiscard]] std::string fixed_decimal(double value);

}  // namespace exactff::formats
