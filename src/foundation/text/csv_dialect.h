// How a CSV file separates its fields and writes its numbers. Where the comma is the decimal sign, spreadsheets write
// semicolons between fields: 7;0,25.
#pragma once

#include <string_view>
#include <vector>

#include "text/csv_lines.h"
#include "text/number_text.h"

namespace exactff::text {

class CsvDialect {
 public:
  CsvDialect() = default;
  // By the first line that is neither blank nor a comment. Semicolons separate its fields if it has some outside
  // quotes, and either no comma there or nothing but numbers between them.
  explicit CsvDialect(std::string_view line);

  [[nodiscard]] bool has_semicolons() const { return separator_ == ';'; }
  [[nodiscard]] bool split(std::string_view line, std::vector<std::string>& fields) const {
    return split_csv_line(line, fields, separator_);
  }
  // With semicolons, a number may have a decimal comma. But one file has either commas or points in its numbers: beside
  // 0.5, 1,234 may be 1234.
  [[nodiscard]] ParsedNumber number(std::string_view text);

 private:
  char separator_ = ',';
  char decimal_sign_ = 0;  // of the numbers so far
};

}  // namespace exactff::text
