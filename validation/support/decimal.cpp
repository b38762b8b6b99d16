#include "support/decimal.h"

#include <cctype>
#include <stdexcept>
#include <string>

namespace exactff::validation {

namespace {

mpq_class power_of_ten(long exponent) {
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(exponent < 0 ? -exponent : exponent));
  return exponent < 0 ? mpq_class(1, power) : mpq_class(power);
}

}  // namespace

Decimal read_decimal(std::string_view text) {
  const std::size_t mark = text.find_first_of("eE");
  long exponent = 0;
  if (mark != std::string_view::npos) exponent = std::stol(std::string(text.substr(mark + 1)));
  std::string digits;
  bool after_point = false;
  for (const char c : text.substr(0, mark)) {
    const bool is_digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (is_digit && after_point) --exponent;
    if (is_digit || (c == '-' && digits.empty())) {
      digits += c;
    } else if (c == '.' && !after_point) {
      after_point = true;
    } else {
      throw std::invalid_argument("not a decimal: " + std::string(text));
    }
  }
  const mpq_class unit = power_of_ten(exponent);
  return {mpz_class(digits, 10) * unit, unit / 2};
}

}  // namespace exactff::validation
