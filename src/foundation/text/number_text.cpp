// std::from_chars rounds correctly, but rejects a plus sign, accepts "nan" and leaves the value unset where it
// underflows. So: check the grammar, strip the plus, and where from_chars reports "out of range", distinguish overflow
// from underflow exactly, with rational numbers.
#include "text/number_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "kernel/numbers.h"
#include "text/names.h"
#include "text/text_lines.h"

namespace exactff::text {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// The parts of [+-] whole [. fraction] [e exponent].
struct Decimal {
  bool negative = false;
  std::string_view whole;
  std::string_view fraction;
  std::string_view exponent;  // with its sign
  bool valid = false;
};

std::string_view take_digits(std::string_view& rest) {
  const auto end = std::find_if_not(rest.begin(), rest.end(), is_digit);
  const std::string_view digits = rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
  rest.remove_prefix(digits.size());
  return digits;
}

bool take(std::string_view& rest, std::string_view any_of) {
  if (rest.empty() || any_of.find(rest.front()) == std::string_view::npos) return false;
  rest.remove_prefix(1);
  return true;
}

Decimal split(std::string_view text) {
  Decimal number;
  std::string_view rest = text;
  number.negative = text.starts_with('-');
  take(rest, "+-");
  number.whole = take_digits(rest);
  if (take(rest, ".")) number.fraction = take_digits(rest);
  bool exponent_complete = true;
  if (take(rest, "eE")) {
    const std::string_view start = rest;
    take(rest, "+-");
    exponent_complete = !take_digits(rest).empty();
    number.exponent = start.substr(0, start.size() - rest.size());
  }
  number.valid = rest.empty() && exponent_complete && !(number.whole.empty() && number.fraction.empty());
  return number;
}

// Clamped to +-10^9: no file has enough digits to compensate for such an exponent.
long exponent_value(std::string_view text) {
  constexpr long kLimit = 1'000'000'000;
  std::string_view digits = text;
  take(digits, "+-");
  long value = 0;
  for (const char c : digits) value = std::min(kLimit, 10 * value + (c - '0'));
  return text.starts_with('-') ? -value : value;
}

// The number as digits * 10^exponent without leading and trailing zeros.
struct Digits {
  std::string text;
  long exponent = 0;
};

Digits significant(const Decimal& number) {
  Digits digits{std::string(number.whole) + std::string(number.fraction), exponent_value(number.exponent)};
  digits.exponent -= static_cast<long>(number.fraction.size());
  digits.text.erase(0, std::min(digits.text.find_first_not_of('0'), digits.text.size()));
  const std::size_t end = digits.text.find_last_not_of('0') + 1;
  digits.exponent += static_cast<long>(digits.text.size() - end);
  digits.text.resize(end);
  return digits;
}

// For what from_chars does not read: values far outside the range of doubles, or near its ends.
double rounded_exactly(const Digits& digits) {
  const long magnitude = digits.exponent + static_cast<long>(digits.text.size());  // value < 10^magnitude
  if (digits.text.empty() || magnitude < -400) return 0.0;
  if (magnitude > 400) return HUGE_VAL;
  kernel::Integer power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(digits.exponent)));
  const kernel::Integer mantissa(digits.text, 10);
  if (digits.exponent >= 0) return kernel::nearest_double(kernel::Rational(mantissa * power));
  return kernel::nearest_double(kernel::Rational(mantissa, power));
}

NumberFault fault_of(std::string_view text) {
  std::string word = in_lower_case(text);
  if (word.starts_with('+') || word.starts_with('-')) word.erase(0, 1);
  if (word.starts_with("nan") || word.starts_with("inf") || word.starts_with("1.#")) return NumberFault::kNotFinite;
  if (word.starts_with("0x")) return NumberFault::kHexadecimal;
  std::replace(word.begin(), word.end(), ',', '.');
  return text.find(',') != std::string_view::npos && split(word).valid ? NumberFault::kComma : NumberFault::kNotANumber;
}

// Nearly all numbers: std::from_chars reads the whole text except for a plus sign, and it begins as a number, not as
// "nan" or "inf".
std::optional<double> plain_number(std::string_view text) {
  const std::size_t sign = text.starts_with('+') || text.starts_with('-') ? 1 : 0;
  if (sign == text.size() || (!is_digit(text[sign]) && text[sign] != '.')) return std::nullopt;
  if (text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value == 0.0 ? 0.0 : value;  // no -0
}

}  // namespace

ParsedNumber parse_number(std::string_view text) {
  if (const auto value = plain_number(text)) return {*value, NumberFault::kNone};
  const Decimal number = split(text);
  if (!number.valid) return {0.0, fault_of(text)};
  const double magnitude = rounded_exactly(significant(number));
  if (std::isinf(magnitude)) return {0.0, NumberFault::kTooLarge};
  return {number.negative && magnitude != 0.0 ? -magnitude : magnitude, NumberFault::kNone};
}

double not_finite_value(std::string_view text, NumberFault fault) {
  const std::string word = in_lower_case(text);
  const double infinity =
      text.starts_with('-') ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  if (fault == NumberFault::kTooLarge || word.find("inf") != std::string::npos) return infinity;
  return std::numeric_limits<double>::quiet_NaN();
}

std::string describe(NumberFault fault, std::string_view text) {
  constexpr std::array<std::string_view, 7> kWords = {" is a number",
                                                      " is not a number",
                                                      " is not a finite number",
                                                      " is hexadecimal",
                                                      " has a decimal comma",
                                                      " is too large for a double",
                                                      " has a decimal point, and a number above it a decimal comma,"};
  return in_quotes(text).append(kWords[static_cast<std::size_t>(fault)]);
}

std::string advice(NumberFault fault) {
  constexpr std::array<const char*, 7> kAdvice = {"",
                                                  "write a decimal number such as 1.5 or -2e-3",
                                                  "give a finite number",
                                                  "write a decimal number such as 1.5 or -2e-3",
                                                  "write a decimal point",
                                                  "give a smaller number; the largest double is about 1.8e308",
                                                  "write all numbers alike"};
  return kAdvice[static_cast<std::size_t>(fault)];
}

}  // namespace exactff::text
