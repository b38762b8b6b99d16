#include "table/csv.h"

#include <algorithm>
#include <utility>

#include "text/escape.h"
#include "text/names.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::table {

std::string csv_head(std::string_view kind, const Head& head, std::span<const Column> columns) {
  std::string lines = "# " + head_line(kind, head, columns) + '\n';
  CsvLine names(lines);
  for (const Column& column : columns) names.add(std::string_view(column.name));
  return lines;
}

std::optional<ParsedHead> parse_csv_head(std::string_view lines) {
  const std::string_view first = lines.substr(0, lines.find('\n'));
  return first.starts_with("# {") ? parse_head(first.substr(2)) : std::nullopt;
}

void CsvLine::add(const Cell& cell) {
  const bool is_first = std::exchange(first_, false);
  if (!is_first) text_ += ',';
  std::visit(
      [&](const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::same_as<Value, double>) {
          text_ += text::shortest(value);
        } else if constexpr (std::same_as<Value, std::uint64_t>) {
          text_ += std::to_string(value);
        } else if constexpr (std::same_as<Value, bool>) {
          text_ += value ? "yes" : "no";
        } else if constexpr (std::same_as<Value, std::string_view>) {
          // A line that begins with '#' would be a comment.
          const std::string field = text::csv_field(value);
          text_ += is_first && field.starts_with('#') ? '"' + field + '"' : field;
        }
      },
      cell);
}

// --- Reading ---

namespace {

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i > 0 ? "," : "") + names[i];
  return text::in_quotes(text + (names.size() > kShown ? ",..." : ""), text::kShownName);
}

}  // namespace

CsvReader::CsvReader(const std::filesystem::path& path, const std::string& purpose) : lines_(path, purpose) {
  read_names();
}

CsvReader::CsvReader(std::istream& in, std::string file, const std::string& purpose)
    : lines_(in, std::move(file), purpose) {
  read_names();
}

void CsvReader::read_names() {
  for (std::string_view line; lines_.next(line);) {
    if (!text::is_csv_comment(line)) {
      dialect_ = text::CsvDialect(line);
      if (split(line)) take_names();
      return;
    }
    if (lines_.number() == 1) take_head(line);
  }
  complain("the file has no column names", "columns are identified by their names",
           "begin the file with a line of names, separated by commas");
}

void CsvReader::take_head(std::string_view comment) {
  head_ = parse_csv_head(comment);
  const auto is_old = [&](const char* kind) { return comment.find(kind) != std::string_view::npos; };
  const bool was_table =
      comment.starts_with("# exactff ") && (is_old(" truth: ") || is_old(" matrix: ") || is_old(" radiosity: "));
  if (head_ || !(was_table || comment.starts_with("# {\"exactff\""))) return;
  text::refuse(lines_.file(), 1, "the head is not that of a table of this version",
               "what its rows mean follows from the head", "compute the file again");
}

const ParsedHead& CsvReader::require_kind(std::string_view kind, const std::string& advice) {
  if (head_ && head_->kind == kind) return *head_;
  text::refuse(lines_.file(), 1, head_ ? "is a table of the kind " + text::in_quotes(head_->kind) : "has no head",
               "a table of the kind " + text::in_quotes(kind) + " is needed", advice);
}

void CsvReader::take_names() {
  names_ = fields_;
  for (auto name = names_.begin(); name != names_.end(); ++name) {
    if (std::find(names_.begin(), name, *name) == name) continue;
    complain("column " + text::in_quotes(*name) + " occurs twice", "only one can count", "rename one");
  }
  for (const Column& column : head_ ? head_->columns : std::vector<Column>()) {
    if (std::ranges::find(names_, column.name) != names_.end()) continue;
    complain("there is no column " + text::in_quotes(column.name), "the head says that the table has it",
             "use the file as exactff wrote it");
  }
  if (names_.size() > 1 || names_.front().find('\t') == std::string::npos) return;
  complain("the column names are separated by tabs", "fields are separated by commas or semicolons",
           "write commas instead of tabs");
}

std::optional<std::size_t> CsvReader::column(std::string_view name) const {
  const auto found = std::ranges::find(names_, name);
  return found == names_.end() ? std::nullopt : std::optional<std::size_t>(found - names_.begin());
}

std::optional<std::size_t> CsvReader::first_column(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    if (const auto found = column(name)) return found;
  }
  return std::nullopt;
}

std::size_t CsvReader::needed_column(std::initializer_list<std::string_view> names, const std::string& why,
                                     const std::string& suggestion) {
  if (const auto found = first_column(names)) return *found;
  if (names_.empty()) return 0;  // a complaint was already made
  std::string wanted;
  for (const std::string_view name : names) wanted += (wanted.empty() ? "" : " or ") + text::in_quotes(name);
  complain("there is no column " + wanted + " among " + listed(names_), why, suggestion);
  return 0;
}

bool CsvReader::split(std::string_view line) {
  if (dialect_.split(line, fields_)) return true;
  complain("a quotation mark is not closed in its line, or text follows it", "the fields cannot be separated",
           "write a quotation mark inside quotes twice");
  return false;
}

bool CsvReader::next() {
  for (std::string_view line; lines_.next(line);) {
    if (text::is_csv_comment(line) || !split(line)) continue;
    if (fields_.size() == names_.size()) return true;
    complain(std::to_string(fields_.size()) + " fields where there are " + std::to_string(names_.size()) + " columns",
             "values would be assigned to the wrong columns",
             dialect_.has_semicolons() ? "separate fields by semicolons, and quote fields that contain a semicolon"
                                       : "separate fields by commas, and quote fields that contain a comma");
  }
  return false;
}

double CsvReader::number(std::size_t column, NotFinite not_finite) {
  const std::string& field = fields_[column];
  const text::ParsedNumber number = dialect_.number(field);
  if (number.fault == text::NumberFault::kNone) return number.value;
  const bool meant = number.fault == text::NumberFault::kNotFinite || number.fault == text::NumberFault::kTooLarge;
  if (meant && not_finite == NotFinite::kAccept) return text::not_finite_value(field, number.fault);
  if (field.empty()) {
    complain("column " + text::in_quotes(names_[column]) + " is empty", "this column must contain numbers",
             not_finite == NotFinite::kAccept ? "write nan if there is no result, or remove the row" : "");
  } else {
    complain(text::describe(number.fault, field) + " in column " + text::in_quotes(names_[column]),
             "this column must contain numbers", text::advice(number.fault));
  }
  return 0.0;
}

Vec3 CsvReader::vector(const std::array<std::size_t, 3>& columns) {
  const double x = number(columns[0]), y = number(columns[1]), z = number(columns[2]);
  return {x, y, z};
}

Cell CsvReader::cell(std::size_t column, Type type) {
  Cell cell;
  // A spreadsheet that writes semicolons may also write decimal commas.
  const bool is_of_spreadsheet = dialect_.has_semicolons() && type == Type::kNumber && !fields_[column].empty();
  if (!is_of_spreadsheet && parse_cell(fields_[column], type, cell)) return cell;
  if (type == Type::kNumber) {
    cell = number(column, NotFinite::kAccept);  // or complains
  } else {
    complain(text::in_quotes(fields_[column]) + " in column " + text::in_quotes(names_[column]) + " is no " +
                 std::string(to_string(type)),
             type == Type::kFlag ? "a flag is yes or no" : "a count is a whole number",
             "use the file as exactff wrote it");
  }
  return cell;
}

bool parse_cell(const std::string& field, Type type, Cell& cell) {
  cell = Cell();
  switch (type) {
    case Type::kText:
      cell = std::string_view(field);
      return true;
    case Type::kNumber: {
      if (field.empty()) return true;
      const text::ParsedNumber number = text::parse_number(field);
      if (number.fault == text::NumberFault::kNone) {
        // The sign of a zero is one of its bits.
        cell = number.value == 0.0 && field.starts_with('-') ? -0.0 : number.value;
      } else if (number.fault == text::NumberFault::kNotFinite) {
        cell = text::not_finite_value(field, number.fault);
      }
      return cell.index() != 0;
    }
    case Type::kFlag:
      if (field == "yes" || field == "no") cell = field == "yes";
      return cell.index() != 0;
    default:
      if (const auto whole = text::whole_number<std::uint64_t>(field)) cell = *whole;
      return cell.index() != 0;
  }
}

void CsvReader::complain(std::string what, std::string why, std::string suggestion) {
  complain_at(lines_.number(), std::move(what), std::move(why), std::move(suggestion));
}

void CsvReader::complain_at(std::size_t line, std::string what, std::string why, std::string suggestion) {
  problems_.add({lines_.file(), line, std::move(what), std::move(why), std::move(suggestion)});
}

// Columns that the head does not describe, for instance of a spreadsheet, are text.
Table read_csv(CsvReader& reader) {
  std::vector<Column> columns;
  for (const std::string& name : reader.names()) {
    const Column other{.name = name, .type = Type::kText};
    const auto known = std::ranges::find(reader.head()->columns, name, &Column::name);
    columns.push_back(known == reader.head()->columns.end() ? other : *known);
  }
  Table table(reader.head()->kind, reader.head()->head, columns);
  std::vector<Cell> cells(columns.size());
  while (reader.next()) {
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = reader.cell(i, columns[i].type);
    if (reader.is_sound()) table.append(cells, reader.line());
  }
  reader.throw_if_any();
  return table;
}

}  // namespace exactff::table
