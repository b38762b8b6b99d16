#include "text/csv_dialect.h"

#include <algorithm>
#include <string>

namespace exactff::text {
namespace {

bool has_outside_quotes(std::string_view line, char wanted) {
  bool quoted = false;
  return std::ranges::any_of(line, [&](char c) {
    if (c == '"') quoted = !quoted;
    return c == wanted && !quoted;
  });
}

bool holds_numbers(std::string_view line) {
  CsvDialect semicolons("a;b");
  std::vector<std::string> fields;
  return semicolons.split(line, fields) && std::ranges::all_of(fields, [&](const std::string& field) {
           const NumberFault fault = semicolons.number(field).fault;
           return fault != NumberFault::kNotANumber && fault != NumberFault::kHexadecimal;
         });
}

}  // namespace

CsvDialect::CsvDialect(std::string_view line) {
  if (!has_outside_quotes(line, ';')) return;
  if (!has_outside_quotes(line, ',') || holds_numbers(line)) separator_ = ';';
}

ParsedNumber CsvDialect::number(std::string_view text) {
  ParsedNumber number = parse_number(text);
  const bool has_comma = number.fault == NumberFault::kComma;
  if (!has_semicolons() || (!has_comma && text.find('.') == std::string_view::npos)) return number;
  const char sign = has_comma ? ',' : '.';
  if (decimal_sign_ == 0) decimal_sign_ = sign;
  if (decimal_sign_ != sign) return {0.0, has_comma ? NumberFault::kComma : NumberFault::kPoint};
  if (!has_comma) return number;
  std::string with_point(text);
  std::ranges::replace(with_point, ',', '.');
  return parse_number(with_point);
}

}  // namespace exactff::text
