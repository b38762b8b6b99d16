// Formats words, numbers and intervals for tables, reports and messages. Nothing here depends on the locale.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace exactff::text {

// The shortest decimal that reads back to the same double; "nan", "inf", "-inf".
[[nodiscard]] std::string shortest(double value);

// For readers: `digits` significant digits, "0.0123", "1.2·10⁻⁷"; numbers from 100 to 10^7 are rounded to units.
[[nodiscard]] std::string rounded(double value, int digits = 3);
// `digits` significant digits in plain characters, for messages, or as the value of a flag: "0.0123", "1.2e-07".
[[nodiscard]] std::string short_number(double value, int digits = 3);

// "312 ns", "4.51 µs", "1.2 ms", "3.4 s", "2 min 5 s".
[[nodiscard]] std::string duration(double seconds);

// "31.2 %". Gives "0 %" only for none and "100 %" only for all.
[[nodiscard]] std::string share(std::size_t part, std::size_t whole);

// "a, b and c".
[[nodiscard]] std::string enumerate(std::span<const std::string> items);

// "⁻¹²" of -12.
[[nodiscard]] std::string superscript(int number);

// "1 receiver", "12 receivers". Pass `plural` if it is not the noun with an s.
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view noun, std::string_view plural = {});

// "{c} of {whole} {noun}s", or "every one of ...".
[[nodiscard]] std::string counted_of(std::size_t count, std::size_t whole, std::string_view noun);

// The low bits of a number as `digits` hexadecimal digits.
[[nodiscard]] std::string hexadecimal(std::uint64_t value, std::size_t digits);

// The version as all outputs state it: "exactff 0.1.0".
[[nodiscard]] std::string program_version();

// --- Interval ---

// Intervals for readers.

// "[0.812, 1]": the ends are rounded outward by at most a hundredth of the width, so that they hold what the interval
// holds. "1.01773" if both ends round to the same six digits. An end that would be rounded beyond the limit is shown as
// the limit, to six digits.
[[nodiscard]] std::string interval(double lower, double upper, double limit = std::numeric_limits<double>::infinity());

}  // namespace exactff::text
