// Tables: rows of named, typed columns under a head. Truth files, matrices and radiosities are tables.
//
// A table is a CSV file, an archive of NumPy arrays (.npz) or a file of JSON lines (.jsonl). All three hold the same:
//
//   #
//   {"exactff":"0.1.0","table":"matrix","scene_hash":"5a...","columns":[{"name":"from","type":"text","key":true},...]}
//   from,to,factor,lower,upper
//   floor,lamp,0.25,0.25,0.25
//
// The head is one line of JSON: the program's version, what kind of table it is, everything that the rows depend on,
// and the columns. Numbers are written as the shortest decimals that read back to the same doubles, so a table that was
// written and read has the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace exactff::table {

enum class Type : std::uint8_t {
  kText,
  kNumber,  // a double, or nothing: an empty field, NaN in an array, null in JSON
  kCount,   // a whole number from 0 to 2^64 - 1
  kFlag,    // yes or no
};
[[nodiscard]] std::string_view to_string(Type type);  // "text", "number", "count", "flag"

// What is known of the numbers in a column.
enum class Strength : std::uint8_t {
  kGiven,      // input, or the name of something
  kProved,     // a bound, or an exact fact
  kCertified,  // the true value, correctly rounded, where the row's status says so
  kStated,     // as strong as the row says in its column `claim`
  kEstimated,
};
[[nodiscard]] std::string_view to_string(Strength strength);  // "given", "proved", ...

struct Column {
  std::string name;
  Type type = Type::kNumber;
  std::string unit = {};  // "length", "1/length", "Ke": of the scene; "" for pure numbers, names and counts
  Strength strength = Strength::kGiven;
  bool key = false;  // the key columns together identify a row

  friend bool operator==(const Column&, const Column&) = default;
};

// A value of the head.
using HeadValue = std::variant<bool, std::uint64_t, double, std::string, std::vector<std::string>>;

// Named values in an order.
class Head {
 public:
  // Replaces a value of this name in its place. A number must be finite.
  void set(std::string_view name, HeadValue value);
  void remove(std::string_view name);

  [[nodiscard]] const HeadValue* find(std::string_view name) const;
  // Nothing if there is no such value, or one of another type. A whole number is a number, too.
  [[nodiscard]] std::optional<std::string> text(std::string_view name) const;
  [[nodiscard]] std::optional<std::uint64_t> count(std::string_view name) const;
  [[nodiscard]] std::optional<double> number(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> list(std::string_view name) const;  // empty if there is none
  [[nodiscard]] bool flag(std::string_view name) const;                      // false if there is none

  [[nodiscard]] const std::vector<std::pair<std::string, HeadValue>>& values() const { return values_; }
  friend bool operator==(const Head&, const Head&) = default;

 private:
  std::vector<std::pair<std::string, HeadValue>> values_;
};

// One field of a row. Nothing is an empty field.
using Cell = std::variant<std::monostate, double, std::uint64_t, bool, std::string_view>;

class Table {
 public:
  Table() = default;
  // `kind`: "truth", "matrix", ...
  Table(std::string kind, Head head, std::vector<Column> columns);

  [[nodiscard]] const std::string& kind() const { return kind_; }
  [[nodiscard]] const Head& head() const { return head_; }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  [[nodiscard]] std::size_t rows() const { return lines_.size(); }

  // One cell for each column, of its type. `line`: of the file that it was read from.
  void append(std::span<const Cell> row, std::size_t line = 0);
  [[nodiscard]] std::size_t line_of(std::size_t row) const { return lines_[row]; }  // from 1; 0 without a file of lines

  // Views of text are valid as long as the table is not changed.
  [[nodiscard]] Cell at(std::size_t row, std::size_t column) const;
  // All values of a column; requires its type. Nothing is NaN.
  [[nodiscard]] const std::vector<double>& numbers(std::size_t column) const;
  [[nodiscard]] const std::vector<std::string>& texts(std::size_t column) const;
  [[nodiscard]] const std::vector<std::uint64_t>& counts(std::size_t column) const;  // of flags, too: 0 or 1

 private:
  using Values = std::variant<std::vector<double>, std::vector<std::string>, std::vector<std::uint64_t>>;

  std::string kind_;
  Head head_;
  std::vector<Column> columns_;
  std::vector<Values> values_;
  std::vector<std::uint32_t> lines_;
};

// Reads a table in any of the three formats, recognised by its content. Throws one InputError, with line numbers where
// there are lines, if it is no table that exactff wrote, or damaged.
[[nodiscard]] Table read(const std::filesystem::path& file);
// The kind of the table in a file; empty if it is none that exactff wrote, or cannot be read.
[[nodiscard]] std::string kind_of(const std::filesystem::path& file);

// Writes .npz, .jsonl, or else CSV, by the name of the file. The file appears complete or not at all, and replaces
// another one. The bytes depend on the table alone. Throws InputError if it cannot be written.
void write(const Table& table, const std::filesystem::path& file);

// The text of a CSV file.
[[nodiscard]] std::string csv_text(const Table& table);

}  // namespace exactff::table
