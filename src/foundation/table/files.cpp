// Tables as files: which format, NumPy archives and JSON lines. csv.h has CSV files.
//
// An archive holds an array for each column, under its name, and the head as the array `head` of bytes. Of JSON lines,
// the first is the head, and each other one is an object with a value for each column.
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

#include "exactff/table.h"
#include "files/file.h"
#include "files/numpy.h"
#include "kernel/float_environment.h"
#include "table/csv.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::table {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kHeadArray = "head";
constexpr const char* kPurpose = "a table that exactff wrote";

[[noreturn]] void refuse_damaged(const fs::path& file, std::size_t line, const std::string& what) {
  text::refuse(file, line, what, "the table cannot be read", "write it again");
}

// --- NumPy archives ---

void write_npz(const Table& table, const fs::path& path) {
  files::NpzFile file(path);
  file.add_word(kHeadArray, head_line(table.kind(), table.head(), table.columns()));
  for (std::size_t i = 0; i < table.columns().size(); ++i) {
    const Column& column = table.columns()[i];
    switch (column.type) {
      case Type::kText:
        file.add_texts(column.name, table.texts(i));
        break;
      case Type::kNumber:
        file.add(column.name, table.numbers(i));
        break;
      case Type::kCount:
        file.add(column.name, table.counts(i));
        break;
      case Type::kFlag: {
        const std::vector<std::uint64_t>& flags = table.counts(i);
        file.add(column.name, std::vector<std::uint8_t>(flags.begin(), flags.end()));
      }
    }
  }
  file.commit();
}

// The values of a column; flags are 0 and 1.
using Array =
    std::variant<std::vector<std::string>, std::vector<double>, std::vector<std::uint64_t>, std::vector<std::uint8_t>>;

Array array_of(const files::NpzReader& archive, const Column& column) {
  switch (column.type) {
    case Type::kText:
      return archive.texts(column.name);
    case Type::kNumber:
      return archive.numbers<double>(column.name);
    case Type::kCount:
      return archive.numbers<std::uint64_t>(column.name);
    default:
      return archive.numbers<std::uint8_t>(column.name);
  }
}

Cell cell_of(const std::string& text) { return std::string_view(text); }
Cell cell_of(double number) { return number; }
Cell cell_of(std::uint64_t count) { return count; }
Cell cell_of(std::uint8_t flag) { return flag != 0; }

Table read_npz(const fs::path& path) {
  const files::NpzReader archive(path);
  const std::optional<ParsedHead> head = parse_head(archive.word(kHeadArray));
  if (!head) refuse_damaged(path, 0, "the array 'head' is not the head of a table of this version");
  std::vector<Array> arrays;
  for (const Column& column : head->columns) {
    arrays.push_back(array_of(archive, column));
    const auto size = [](const Array& array) { return std::visit([](const auto& all) { return all.size(); }, array); };
    if (size(arrays.back()) == size(arrays.front())) continue;
    refuse_damaged(path, 0, "the arrays of the columns have different lengths");
  }
  Table table(head->kind, head->head, head->columns);
  std::vector<Cell> cells(arrays.size());
  const std::size_t rows = std::visit([](const auto& all) { return all.size(); }, arrays.front());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells[i] = std::visit([row](const auto& all) { return cell_of(all[row]); }, arrays[i]);
    }
    table.append(cells);
  }
  return table;
}

// --- JSON lines ---

ordered_json json_of(const Cell& cell) {
  return std::visit(
      [](const auto& value) -> ordered_json {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::same_as<Value, std::monostate>) {
          return nullptr;
        } else if constexpr (std::same_as<Value, double>) {
          if (!std::isfinite(value)) return text::shortest(value);  // JSON has no infinity
          return value;
        } else {
          return value;
        }
      },
      cell);
}

void write_json_lines(const Table& table, files::WholeFile& file) {
  file.append(head_line(table.kind(), table.head(), table.columns()) + '\n');
  for (std::size_t row = 0; row < table.rows(); ++row) {
    ordered_json json = ordered_json::object();
    for (std::size_t i = 0; i < table.columns().size(); ++i) json[table.columns()[i].name] = json_of(table.at(row, i));
    file.append(text::json_line(json) + '\n');
  }
}

// Returns false if the value is none of this type. Text points into `json`.
bool read_cell(const ordered_json& json, Type type, Cell& cell) {
  switch (type) {
    case Type::kText:
      if (!json.is_string()) return false;
      cell = std::string_view(json.get_ref<const std::string&>());
      return true;
    case Type::kNumber:
      if (json.is_null()) {
        cell = std::monostate();
      } else if (json.is_number()) {
        cell = json.get<double>();
      } else if (json == "inf" || json == "-inf") {
        cell = json == "inf" ? HUGE_VAL : -HUGE_VAL;
      } else {
        return false;
      }
      return true;
    case Type::kCount:
      if (!json.is_number_unsigned()) return false;
      cell = json.get<std::uint64_t>();
      return true;
    default:
      if (!json.is_boolean()) return false;
      cell = json.get<bool>();
      return true;
  }
}

Table read_json_lines(const fs::path& path) {
  text::CsvLines lines(path, kPurpose);
  std::string_view line;
  const std::optional<ParsedHead> head = lines.next(line) ? parse_head(line) : std::nullopt;
  if (!head) refuse_damaged(path, 1, "the line is not the head of a table of this version");
  Table table(head->kind, head->head, head->columns);
  std::vector<Cell> cells(head->columns.size());
  while (lines.next(line)) {
    const ordered_json json = ordered_json::parse(line, nullptr, false);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Column& column = head->columns[i];
      if (json.is_object() && json.contains(column.name) && read_cell(json[column.name], column.type, cells[i]))
        continue;
      refuse_damaged(path, lines.number(),
                     "the line has no " + std::string(to_string(column.type)) + ' ' + text::in_quotes(column.name));
    }
    table.append(cells, lines.number());
  }
  return table;
}

enum class Format { kNone, kCsv, kNpz, kJsonLines };

Format format_of(const fs::path& file) {
  constexpr std::string_view kCsvStart = "# {\"exactff\"", kJsonStart = "{\"exactff\"";
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return Format::kNone;
  std::ifstream in(file, std::ios::binary);
  std::string start(kCsvStart.size(), '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start.starts_with(kCsvStart)) return Format::kCsv;
  if (start.starts_with(kJsonStart)) return Format::kJsonLines;
  return start.starts_with("PK\x03\x04") ? Format::kNpz : Format::kNone;
}

}  // namespace

Table read(const fs::path& file) {
  const kernel::StandardArithmetic arithmetic;
  switch (format_of(file)) {
    case Format::kNpz:
      return read_npz(file);
    case Format::kJsonLines:
      return read_json_lines(file);
    default: {
      CsvReader reader(file, kPurpose);
      if (!reader.head()) refuse_damaged(file, 1, "the file is no table that exactff wrote: it has no head");
      return read_csv(reader);
    }
  }
}

std::string kind_of(const fs::path& file) {
  try {
    std::optional<ParsedHead> head;
    std::string_view line;
    switch (format_of(file)) {
      case Format::kNpz:
        head = parse_head(files::NpzReader(file).word(kHeadArray));
        break;
      case Format::kNone:
        break;
      default:
        text::CsvLines lines(file, kPurpose);
        if (lines.next(line)) head = line.starts_with('{') ? parse_head(line) : parse_csv_head(line);
    }
    return head ? head->kind : std::string();
  } catch (const InputError&) {  // read() says why
    return {};
  }
}

void write(const Table& table, const fs::path& path) {
  const kernel::StandardArithmetic arithmetic;
  if (path.extension() == ".npz") return write_npz(table, path);
  files::WholeFile file(path);
  if (path.extension() == ".jsonl") {
    write_json_lines(table, file);
  } else {
    file.append(csv_text(table));
  }
  file.commit();
}

std::string csv_text(const Table& table) {
  const kernel::StandardArithmetic arithmetic;
  std::string text = csv_head(table.kind(), table.head(), table.columns());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    CsvLine line(text);
    for (std::size_t i = 0; i < table.columns().size(); ++i) line.add(table.at(row, i));
  }
  return text;
}

}  // namespace exactff::table
