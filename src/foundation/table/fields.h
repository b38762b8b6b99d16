// How a row's values become the fields of a table, and back: one entry for each column, for every format.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/table.h"
#include "table/csv.h"

namespace exactff::table {

// A column of rows of this kind. `Get` and `Set` are function pointers, so a schema is a list of lambdas without
// capture.
template <class Row>
struct Field {
  using Get = Cell (*)(const Row&);
  using Set = bool (*)(Row&, const Cell&);  // false if the row cannot have this value

  Column column;
  Get get = nullptr;
  Set set = nullptr;  // not for columns that follow from others
};

// How a member of the row becomes a cell, and back: a double, a whole number, a bool or a text.
template <auto Member, class Row>
struct MemberCell {
  using Value = std::remove_cvref_t<decltype(std::declval<Row&>().*Member)>;
  static constexpr bool kIsFlag = std::same_as<Value, bool>, kIsCount = std::integral<Value> && !kIsFlag,
                        kIsNumber = std::same_as<Value, double>;
  static constexpr Type kType = kIsFlag     ? Type::kFlag
                                : kIsCount  ? Type::kCount
                                : kIsNumber ? Type::kNumber
                                            : Type::kText;

  static Cell get(const Row& row) {
    if constexpr (kIsCount) {
      return static_cast<std::uint64_t>(row.*Member);
    } else if constexpr (kIsFlag || kIsNumber) {
      return row.*Member;
    } else {
      return std::string_view(row.*Member);
    }
  }
  static bool set(Row& row, const Cell& cell) {
    if constexpr (kIsCount) {
      const std::uint64_t* const value = std::get_if<std::uint64_t>(&cell);
      if (value != nullptr) row.*Member = static_cast<Value>(*value);
      return value != nullptr && static_cast<std::uint64_t>(row.*Member) == *value;
    } else if constexpr (kIsFlag || kIsNumber) {
      const Value* const value = std::get_if<Value>(&cell);
      if (value != nullptr) row.*Member = *value;
      return value != nullptr;
    } else {
      const std::string_view* const value = std::get_if<std::string_view>(&cell);
      if (value != nullptr) row.*Member = *value;
      return value != nullptr;
    }
  }
};

template <auto Member, class Row>
[[nodiscard]] Field<Row> member_field(Column column) {
  column.type = MemberCell<Member, Row>::kType;
  return {std::move(column), &MemberCell<Member, Row>::get, &MemberCell<Member, Row>::set};
}

// All columns of one kind of table.
template <class Row>
class Fields {
 public:
  Fields(std::string kind, std::vector<Field<Row>> fields) : kind_(std::move(kind)), fields_(std::move(fields)) {
    for (const Field<Row>& field : fields_) columns_.push_back(field.column);
  }

  [[nodiscard]] const std::string& kind() const { return kind_; }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }

  // Appends the row as a line of a CSV file.
  void append_csv(const Row& row, std::string& text) const {
    CsvLine line(text);
    for (const Field<Row>& field : fields_) line.add(field.get(row));
  }
  void append(const Row& row, Table& table) const {
    std::vector<Cell> cells;
    for (const Field<Row>& field : fields_) cells.push_back(field.get(row));
    table.append(cells);
  }

  [[nodiscard]] const std::vector<Field<Row>>& all() const { return fields_; }

  // Sets every value from a line that append_csv wrote, without its end. Returns false if it is none.
  [[nodiscard]] bool read_csv(std::string_view line, Row& into) const {
    std::vector<std::string> texts;
    if (!text::split_csv_line(line, texts) || texts.size() != fields_.size()) return false;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      Cell cell;
      if (!parse_cell(texts[i], fields_[i].column.type, cell)) return false;
      if (fields_[i].set != nullptr && !fields_[i].set(into, cell)) return false;
    }
    return true;
  }

  // Sets every value that the table has and a field takes, from one row of the table. Returns the name of a column
  // whose value is impossible, or nothing.
  [[nodiscard]] std::optional<std::string_view> read(const Table& table, std::size_t row, Row& into) const {
    for (const Field<Row>& field : fields_) {
      if (field.set == nullptr) continue;
      const std::optional<std::size_t> column = table.column(field.column.name);
      if (!column) continue;
      const bool is_of_type = table.columns()[*column].type == field.column.type;
      if (!is_of_type || !field.set(into, table.at(row, *column))) return field.column.name;
    }
    return std::nullopt;
  }

 private:
  std::string kind_;
  std::vector<Field<Row>> fields_;
  std::vector<Column> columns_;
};

// The rows of a table in a CSV file, one after another, with the values of those columns that the file has.
template <class Row>
class RowReader {
 public:
  // Throws InputError unless it is a table of this kind. `advice`: "name a file that exactff truth has written".
  RowReader(const std::filesystem::path& file, const Fields<Row>& fields, const std::string& advice)
      : csv_(file, "a table of the kind " + fields.kind()) {
    (void)csv_.require_kind(fields.kind(), advice);
    csv_.throw_if_any();
    for (const Field<Row>& field : fields.all()) {
      const std::optional<std::size_t> column = csv_.column(field.column.name);
      if (column && field.set != nullptr) fields_.emplace_back(*column, &field);
    }
  }

  [[nodiscard]] const ParsedHead& head() const { return *csv_.head(); }
  [[nodiscard]] bool has(std::string_view column) const { return csv_.column(column).has_value(); }
  [[nodiscard]] std::size_t line() const { return csv_.line(); }

  // False at the end. Throws InputError at a row that is damaged.
  [[nodiscard]] bool next(Row& row) {
    if (!csv_.next()) {
      csv_.throw_if_any();
      return false;
    }
    for (const auto& [column, field] : fields_) {
      const Cell cell = csv_.cell(column, field->column.type);
      if (csv_.is_sound() && !field->set(row, cell)) damaged();
    }
    csv_.throw_if_any();
    return true;
  }

  [[noreturn]] void damaged() {
    csv_.complain("is not a row of a table of the kind " + head().kind, "every row is needed",
                  "compute the file again");
    csv_.throw_if_any();
    std::abort();  // not reached
  }

 private:
  CsvReader csv_;
  std::vector<std::pair<std::size_t, const Field<Row>*>> fields_;  // by column
};

}  // namespace exactff::table
