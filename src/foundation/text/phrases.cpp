#include "text/phrases.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "exactff/version.h"
#include "text/number_text.h"

namespace exactff::text {
namespace {

// By std::to_chars, whose further arguments are a format and a number of digits.
template <class... How>
std::string decimal(double value, How... how) {
  std::array<char, 400> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, how...);
  return {buffer.data(), end.ptr};
}

std::string fixed(double value, int decimals) { return decimal(value, std::chars_format::fixed, decimals); }

// "4.1e-05" to "4.1·10⁻⁵".
std::string with_power_of_ten(const std::string& text) {
  const std::size_t e = text.find('e');
  return e == std::string::npos ? text : text.substr(0, e) + "·10" + superscript(std::stoi(text.substr(e + 1)));
}

}  // namespace

std::string superscript(int number) {
  constexpr std::array<std::string_view, 10> kDigits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : std::to_string(number)) text += c == '-' ? "⁻" : kDigits[static_cast<std::size_t>(c - '0')];
  return text;
}

std::string shortest(double value) { return decimal(value); }

std::string rounded(double value, int digits) {
  if (value == 0.0) return "0";
  const double magnitude = std::abs(value);
  if (magnitude >= 100.0 && magnitude < 1e7) return fixed(value, 0);
  return with_power_of_ten(short_number(value, digits));
}

std::string duration(double seconds) {
  if (!(seconds >= 0.0)) return "?";
  if (seconds < 1e-6) return rounded(seconds * 1e9) + " ns";
  if (seconds < 1e-3) return rounded(seconds * 1e6) + " µs";
  if (seconds < 1.0) return rounded(seconds * 1e3) + " ms";
  if (seconds < 100.0) return rounded(seconds) + " s";
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

std::string share(std::size_t part, std::size_t whole) {
  if (part == 0 || whole == 0) return "0 %";
  if (part == whole) return "100 %";
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  if (percent < 0.05) return "under 0.1 %";
  if (percent >= 99.95) return "over 99.9 %";
  return fixed(percent, 1) + " %";
}

std::string enumerate(std::span<const std::string> items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? " and " : ", ";
    text += items[i];
  }
  return text;
}

std::string counted(std::uint64_t count, std::string_view noun, std::string_view plural) {
  std::string text = std::to_string(count) + ' ';
  if (count == 1 || plural.empty()) text += noun;
  if (count != 1) text += plural.empty() ? std::string_view("s") : plural;
  return text;
}

std::string counted_of(std::size_t count, std::size_t whole, std::string_view noun) {
  return (count == whole ? std::string("every one") : std::to_string(count)) + " of " + counted(whole, noun);
}

std::string short_number(double value, int digits) { return decimal(value, std::chars_format::general, digits); }

std::string hexadecimal(std::uint64_t value, std::size_t digits) {
  std::string text(digits, '0');
  for (std::size_t i = digits; i-- > 0; value >>= 4U) text[i] = "0123456789abcdef"[value & 15U];
  return text;
}

std::string program_version() { return std::string("exactff ") + kVersion; }

// --- Interval ---

namespace {

double read_back(const std::string& text) {
  const ParsedNumber number = parse_number(text);
  return number.fault == NumberFault::kNone ? number.value : not_finite_value(text, number.fault);
}

enum class Side { kBelow, kAbove };

// The decimal of so many significant digits that is nearest to the value, or the next one on the other side.
double rounded_to(Side side, double value, int digits) {
  std::string text = decimal(value, std::chars_format::scientific, digits - 1);
  const double nearest = read_back(text);
  if (side == Side::kBelow ? nearest <= value : nearest >= value) return nearest;
  const std::size_t e = text.find('e');
  const int exponent = std::stoi(text.substr(e + 1)) - (digits - 1);
  text.resize(e);
  std::erase(text, '.');
  const long long next = std::stoll(text) + (side == Side::kBelow ? -1 : 1);
  return read_back(std::to_string(next) + 'e' + std::to_string(exponent));
}

double rounded_outward(Side side, double value, double tolerance) {
  constexpr int kAllDigits = 17;
  for (int digits = 1; digits < kAllDigits; ++digits) {
    const double end = rounded_to(side, value, digits);
    if (std::abs(end - value) <= tolerance) return end == 0.0 ? 0.0 : end;
  }
  return value;
}

std::string six_digits(double value) { return with_power_of_ten(short_number(value == 0.0 ? 0.0 : value, 6)); }

}  // namespace

std::string interval(double lower, double upper, double limit) {
  constexpr double kHundredth = 0.01;
  if (six_digits(lower) == six_digits(upper)) return six_digits(lower);
  const double tolerance = kHundredth * (upper - lower), low = rounded_outward(Side::kBelow, lower, tolerance),
               high = rounded_outward(Side::kAbove, upper, tolerance);
  return '[' + with_power_of_ten(shortest(low)) + ", " +
         (high > limit ? six_digits(limit) : with_power_of_ten(shortest(high))) + ']';
}

}  // namespace exactff::text
