#include "text/interval.h"

#include <array>
#include <charconv>
#include <cmath>

#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::text {

namespace {

// "4.1e-05" as "4.1·10⁻⁵".
std::string with_superscript(const std::string& decimal) {
  const std::size_t e = decimal.find('e');
  return e == std::string::npos ? decimal
                                : decimal.substr(0, e) + "·10" + superscript(std::stoi(decimal.substr(e + 1)));
}

double read_back(const std::string& decimal) {
  const ParsedNumber number = parse_number(decimal);
  return number.fault == NumberFault::kNone ? number.value : not_finite_value(decimal, number.fault);
}

enum class Side { kBelow, kAbove };

// The decimal of so many significant digits that is nearest to the value, or the next one on the other side.
double rounded_to(Side side, double value, int digits) {
  std::array<char, 64> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::scientific, digits - 1);
  std::string decimal(buffer.data(), end.ptr);
  const double nearest = read_back(decimal);
  if (side == Side::kBelow ? nearest <= value : nearest >= value) return nearest;
  const std::size_t e = decimal.find('e');
  const int exponent = std::stoi(decimal.substr(e + 1)) - (digits - 1);
  decimal.resize(e);
  std::erase(decimal, '.');
  const long long next = std::stoll(decimal) + (side == Side::kBelow ? -1 : 1);
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

std::string six_digits(double value) { return with_superscript(short_number(value == 0.0 ? 0.0 : value, 6)); }

}  // namespace

std::string interval(double lower, double upper, double limit) {
  constexpr double kHundredth = 0.01;
  if (six_digits(lower) == six_digits(upper)) return six_digits(lower);
  const double tolerance = kHundredth * (upper - lower), low = rounded_outward(Side::kBelow, lower, tolerance),
               high = rounded_outward(Side::kAbove, upper, tolerance);
  return '[' + with_superscript(shortest(low)) + ", " +
         (high > limit ? six_digits(limit) : with_superscript(shortest(high))) + ']';
}

}  // namespace exactff::text
