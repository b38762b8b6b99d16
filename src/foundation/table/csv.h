// Tables as CSV files: the head as a comment of one line of JSON, the names of the columns, the rows. Also CSV files of
// other programs, which have no such head.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/table.h"
#include "text/csv_lines.h"
#include "text/text_lines.h"

namespace exactff::table {

// The head of a table of this kind as one line of JSON, without a line break. It holds ASCII and visible UTF-8 only.
[[nodiscard]] std::string head_line(std::string_view kind, const Head& head, std::span<const Column> columns);

struct ParsedHead {
  std::string kind;
  Head head;
  std::vector<Column> columns;
};
// Nothing unless head_line has written it.
[[nodiscard]] std::optional<ParsedHead> parse_head(std::string_view json);

// For readers: a text, yes or no, a number, "a, b and c".
[[nodiscard]] std::string words_of(const HeadValue& value);
// The head in lines "name: value", after the version and the kind: for files that keep texts.
[[nodiscard]] std::vector<std::string> lines_of(const ParsedHead& head);

// The lines above the rows.
[[nodiscard]] std::string csv_head(std::string_view kind, const Head& head, std::span<const Column> columns);
// Of such lines; nothing if they are not those of a table.
[[nodiscard]] std::optional<ParsedHead> parse_csv_head(std::string_view lines);

// A line of a CSV file, appended to a text. Fields are added from left to right.
class CsvLine {
 public:
  explicit CsvLine(std::string& text) : text_(text), start_(text.size()) {}
  // A blank line would be none.
  ~CsvLine() { text_ += text_.size() == start_ ? "\"\"\n" : "\n"; }
  CsvLine(const CsvLine&) = delete;
  CsvLine& operator=(const CsvLine&) = delete;

  void add(const Cell& cell);

 private:
  std::string& text_;
  const std::size_t start_;
  bool first_ = true;
};

// A field that exactff wrote as a value of this type. Returns false if it is none. Text points into `field`.
[[nodiscard]] bool parse_cell(const std::string& field, Type type, Cell& cell);

enum class NotFinite { kRefuse, kAccept };

// Reads a CSV file with a row of column names, row by row, in either dialect (text/csv_lines.h). Collects problems.
class CsvReader {
 public:
  // Reads the file up to and including the column names. `purpose` completes "give ...". Refuses a file of exactff
  // whose head is no JSON: it is of an older version.
  CsvReader(const std::filesystem::path& path, const std::string& purpose);
  // The same from an open stream, called `file` in messages.
  CsvReader(std::istream& in, std::string file, const std::string& purpose);

  [[nodiscard]] const std::string& file() const { return lines_.file(); }
  [[nodiscard]] std::size_t line() const { return lines_.number(); }
  // Of a table that exactff wrote.
  [[nodiscard]] const std::optional<ParsedHead>& head() const { return head_; }
  // Throws InputError unless it is a table of this kind. `advice`: "give a file written by `exactff matrix -o`".
  const ParsedHead& require_kind(std::string_view kind, const std::string& advice);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  // The first of these columns that exists.
  [[nodiscard]] std::optional<std::size_t> first_column(std::initializer_list<std::string_view> names) const;
  // The same; makes a complaint if there is none.
  [[nodiscard]] std::size_t needed_column(std::initializer_list<std::string_view> names, const std::string& why,
                                          const std::string& suggestion);
  [[nodiscard]] const std::string& name_of(std::size_t column) const { return names_[column]; }

  // Reads the next row with as many fields as there are column names. Complains about other rows and skips them.
  [[nodiscard]] bool next();
  [[nodiscard]] const std::string& field(std::size_t column) const { return fields_[column]; }
  [[nodiscard]] double number(std::size_t column, NotFinite not_finite = NotFinite::kRefuse);
  [[nodiscard]] Vec3 vector(const std::array<std::size_t, 3>& columns);
  // The field as a value of this type; complains, and returns nothing, if it is none. Text stays valid until next().
  [[nodiscard]] Cell cell(std::size_t column, Type type);

  void complain(std::string what, std::string why, std::string suggestion = {});
  void complain_at(std::size_t line, std::string what, std::string why, std::string suggestion = {});
  [[nodiscard]] bool is_sound() const { return problems_.empty(); }
  void throw_if_any() { problems_.throw_if_any(); }

 private:
  void read_names();
  void take_names();
  void take_head(std::string_view comment);
  [[nodiscard]] bool split(std::string_view line);

  text::CsvLines lines_;
  text::CsvDialect dialect_;
  std::optional<ParsedHead> head_;
  std::vector<std::string> names_;
  std::vector<std::string> fields_;
  text::ProblemList problems_;
};

// A whole table of this kind that exactff wrote. Throws one InputError with file:line for every problem.
[[nodiscard]] Table read_csv(CsvReader& reader);

}  // namespace exactff::table
