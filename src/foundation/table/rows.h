// Fills a table row by row, value by value. For tables that are only written.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/table.h"

namespace exactff::table {

using Columns = std::vector<Column>;

// Columns that differ in their names alone: "x,y,z".
[[nodiscard]] Columns columns(std::string_view names, const Column& like);
[[nodiscard]] inline Columns texts(std::string_view names, Strength strength = Strength::kGiven) {
  return columns(names, {.name = {}, .type = Type::kText, .strength = strength});
}
[[nodiscard]] inline Columns flags(std::string_view names) {
  return columns(names, {.name = {}, .type = Type::kFlag, .strength = Strength::kProved});
}
[[nodiscard]] inline Columns counts(std::string_view names) {
  return columns(names, {.name = {}, .type = Type::kCount, .strength = Strength::kProved});
}
[[nodiscard]] inline Columns numbers(std::string_view names, Strength strength, std::string unit = {}) {
  return columns(names, {.name = {}, .unit = std::move(unit), .strength = strength});
}
[[nodiscard]] inline Columns keys(std::string_view names, Type type = Type::kText) {
  return columns(names, {.name = {}, .type = type, .key = true});
}

[[nodiscard]] Columns joined(std::initializer_list<Columns> lists);

// A row begins with the first value after the last one of the row before.
class Rows {
 public:
  Rows(std::string kind, Head head, std::initializer_list<Columns> columns);

  // A text, a whole number, yes or no, a double, or nothing: of the column's type, or to be written as it.
  template <class Value>
  Rows& operator<<(const Value& value) {
    if constexpr (std::same_as<Value, Vec3>) {
      return *this << value.x << value.y << value.z;
    } else if constexpr (std::convertible_to<Value, std::string_view>) {
      add(std::string_view(value));
    } else if constexpr (std::same_as<Value, bool> || std::same_as<Value, double>) {
      add(value);
    } else if constexpr (std::integral<Value>) {
      add_whole(static_cast<std::uint64_t>(value));
    } else if (value) {  // std::optional
      return *this << *value;
    } else {
      add(Cell());
    }
    return *this;
  }

  [[nodiscard]] Table take() { return std::move(table_); }

 private:
  void add(const Cell& cell);
  void add_whole(std::uint64_t value);

  Table table_;
  std::vector<Cell> cells_;         // of the present row
  std::vector<std::string> texts_;  // what they show, by column
};

}  // namespace exactff::table
