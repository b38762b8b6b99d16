// The lines and fields of CSV files, read one after another: a file of a million rows is never held in memory as a
// whole.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "text/number_text.h"

namespace exactff::text {

// Lines that end in LF, CRLF or CR; a UTF-8 byte order mark at the start is skipped. Throws InputError where
// read_text_file would: the file is missing, a directory, unreadable, or binary.
class CsvLines {
 public:
  // `purpose` completes "give ...": "a CSV file of values".
  CsvLines(const std::filesystem::path& path, std::string purpose);
  // From an open stream, called `file` in messages.
  CsvLines(std::istream& in, std::string file, std::string purpose);
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  // The next line, blank and comment lines included; valid until the next call.
  bool next(std::string_view& line);
  [[nodiscard]] std::size_t number() const { return number_; }  // of the line last returned, from 1
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  bool fill();
  void pass_line_end();
  void pass_byte_order_mark();

  std::string file_;
  std::string purpose_;
  std::ifstream opened_;
  std::istream& in_;
  std::array<char, 1 << 16> block_{};
  std::size_t at_ = 0;
  std::size_t end_ = 0;
  std::size_t number_ = 0;
  std::string line_;
};

// Blank, or a comment: one that begins with '#'.
[[nodiscard]] bool is_csv_comment(std::string_view line);

// The fields of one line, without outer blanks unless quoted; a quotation mark within quotes is written twice. Returns
// false if a quote is not closed within its line, or text follows a closing quote. Reuses the memory of `fields`. A
// field that is not UTF-8 is converted (text/encoding.h): names match those of scenes, and of files that older versions
// and other programs wrote in Latin-1.
[[nodiscard]] bool split_csv_line(std::string_view line, std::vector<std::string>& fields, char separator = ',');

// How a CSV file separates its fields and writes its numbers. Where the comma is the decimal sign, spreadsheets write
// semicolons between fields: 7;0,25.
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
