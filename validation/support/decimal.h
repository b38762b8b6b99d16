// Decimal text as an exact rational.
#pragma once

#include <gmpxx.h>

#include <string_view>

namespace exactff::validation {

struct Decimal {
  mpq_class value;
  mpq_class half_unit;  // half a unit of the last printed digit: how far rounding may have moved the value
};

// Reads [-]digits[.digits][e[+-]digits]. Throws std::invalid_argument for anything else.
[[nodiscard]] Decimal read_decimal(std::string_view text);

}  // namespace exactff::validation
