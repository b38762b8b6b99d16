// Decimal text to doubles, independent of the locale.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace exactff::text {

enum class NumberFault {
  kNone,
  kNotANumber,  // anything but [+-] digits [. digits] [e [+-] digits] with at least one digit before the exponent
  kNotFinite,   // nan, inf, infinity in any case
  kHexadecimal,
  kComma,     // a number except for a decimal comma
  kTooLarge,  // rounds to infinity
  kPoint,     // a decimal point beside numbers with decimal commas (csv_lines.h)
};

struct ParsedNumber {
  double value = 0.0;
  NumberFault fault = NumberFault::kNone;
};

// The whole text as decimal digits. Nothing for any other text or a value out of range.
template <class Whole>
[[nodiscard]] std::optional<Whole> whole_number(std::string_view text) {
  Whole value{};
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc{} || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

// Correctly rounded to nearest, ties to even, gradual underflow included: 1e-400, -1e-400 and -0 give 0.
ParsedNumber parse_number(std::string_view text);

// What a text with the fault kNotFinite or kTooLarge means: an infinity or NaN. The sign of "nan" is not kept.
double not_finite_value(std::string_view text, NumberFault fault);

// "'1e400' is too large for a double": completes "FILE:LINE: ".
std::string describe(NumberFault fault, std::string_view text);
// What to do about it: completes a Problem.
std::string advice(NumberFault fault);

}  // namespace exactff::text
