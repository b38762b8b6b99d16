// A CSV file with a row of column names, read row by row, in either dialect (csv_dialect.h). Problems are collected.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/geometry.h"
#include "text/csv_dialect.h"
#include "text/csv_lines.h"
#include "text/text_lines.h"

namespace exactff::text {

enum class NotFinite { kRefuse, kAccept };

class CsvTable {
 public:
  // Reads the file up to and including the column names. `purpose` completes "give ...".
  CsvTable(const std::filesystem::path& path, const std::string& purpose);

  [[nodiscard]] const std::string& file() const { return lines_.file(); }
  [[nodiscard]] std::size_t line() const { return lines_.number(); }
  [[nodiscard]] std::vector<std::string>& comments() { return comments_; }  // above the column names, without '#'

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

  void complain(std::string what, std::string why, std::string suggestion = {});
  void complain_at(std::size_t line, std::string what, std::string why, std::string suggestion = {});
  [[nodiscard]] bool is_sound() const { return problems_.empty(); }
  void throw_if_any() { problems_.throw_if_any(); }

 private:
  void read_names();
  void take_names();
  [[nodiscard]] bool split(std::string_view line);

  CsvLines lines_;
  CsvDialect dialect_;
  std::vector<std::string> comments_;
  std::vector<std::string> names_;
  std::vector<std::string> fields_;
  ProblemList problems_;
};

}  // namespace exactff::text
