#include "formats/decimal_complement.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace exactff::formats {

namespace {

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool all_zeros(std::string_view text) { return text.find_first_not_of('0') == std::string_view::npos; }

}  // namespace

std::optional<std::string> decimal_complement(std::string_view x) {
  if (x.starts_with('+')) x.remove_prefix(1);
  const std::size_t point = std::min(x.find('.'), x.size());
  std::string_view whole = x.substr(0, point);
  const std::string_view fraction = x.substr(std::min(point + 1, x.size()));
  if (!all_digits(whole) || !all_digits(fraction) || (whole.empty() && fraction.empty())) return std::nullopt;
  whole.remove_prefix(std::min(whole.find_first_not_of('0'), whole.size()));
  if (all_zeros(fraction)) {
    if (whole.empty()) return "1";
    return whole == "1" ? std::optional<std::string>("0") : std::nullopt;
  }
  if (!whole.empty()) return std::nullopt;
  // Ten less the last digit that is not 0, nine less each digit before it.
  std::string result = "0." + std::string(fraction);
  const std::size_t last = result.find_last_not_of('0');
  for (std::size_t i = 2; i < last; ++i) result[i] = static_cast<char>('0' + ('9' - result[i]));
  result[last] = static_cast<char>('0' + (10 - (result[last] - '0')));
  return result;
}

std::string fixed_decimal(double value) {
  std::array<char, 400> text{};  // the smallest doubles have 324 zeros
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr};
}

}  // namespace exactff::formats
