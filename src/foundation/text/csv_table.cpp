#include "text/csv_table.h"

#include <algorithm>
#include <array>
#include <utility>

#include "text/names.h"
#include "text/number_text.h"

namespace exactff::text {
namespace {

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i > 0 ? "," : "") + names[i];
  return in_quotes(text + (names.size() > kShown ? ",..." : ""), kShownName);
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& path, const std::string& purpose) : lines_(path, purpose) {
  read_names();
}

void CsvTable::read_names() {
  for (std::string_view line; lines_.next(line);) {
    if (!is_csv_comment(line)) {
      dialect_ = CsvDialect(line);
      if (split(line)) take_names();
      return;
    }
    const std::string_view content = trimmed(line);
    if (!content.empty()) comments_.emplace_back(trimmed(content.substr(1)));
  }
  complain("the file has no column names", "columns are identified by their names",
           "begin the file with a line of names, separated by commas");
}

void CsvTable::take_names() {
  names_ = fields_;
  for (auto name = names_.begin(); name != names_.end(); ++name) {
    if (std::find(names_.begin(), name, *name) == name) continue;
    complain("column " + in_quotes(*name) + " occurs twice", "only one can count", "rename one");
  }
  if (names_.size() > 1 || names_.front().find('\t') == std::string::npos) return;
  complain("the column names are separated by tabs", "fields are separated by commas or semicolons",
           "write commas instead of tabs");
}

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

std::optional<std::size_t> CsvTable::first_column(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    if (const auto found = column(name)) return found;
  }
  return std::nullopt;
}

std::size_t CsvTable::needed_column(std::initializer_list<std::string_view> names, const std::string& why,
                                    const std::string& suggestion) {
  if (const auto found = first_column(names)) return *found;
  if (names_.empty()) return 0;  // a complaint was already made
  std::string wanted;
  for (const std::string_view name : names) wanted += (wanted.empty() ? "" : " or ") + in_quotes(name);
  complain("there is no column " + wanted + " among " + listed(names_), why, suggestion);
  return 0;
}

bool CsvTable::split(std::string_view line) {
  if (dialect_.split(line, fields_)) return true;
  complain("a quotation mark is not closed in its line, or text follows it", "the fields cannot be separated",
           "write a quotation mark inside quotes twice");
  return false;
}

bool CsvTable::next() {
  for (std::string_view line; lines_.next(line);) {
    if (is_csv_comment(line) || !split(line)) continue;
    if (fields_.size() == names_.size()) return true;
    complain(std::to_string(fields_.size()) + " fields where there are " + std::to_string(names_.size()) + " columns",
             "values would be assigned to the wrong columns",
             dialect_.has_semicolons() ? "separate fields by semicolons, and quote fields that contain a semicolon"
                                       : "separate fields by commas, and quote fields that contain a comma");
  }
  return false;
}

double CsvTable::number(std::size_t column, NotFinite not_finite) {
  const std::string& text = fields_[column];
  const ParsedNumber number = dialect_.number(text);
  if (number.fault == NumberFault::kNone) return number.value;
  const bool meant = number.fault == NumberFault::kNotFinite || number.fault == NumberFault::kTooLarge;
  if (meant && not_finite == NotFinite::kAccept) return not_finite_value(text, number.fault);
  if (text.empty()) {
    complain("column " + in_quotes(names_[column]) + " is empty", "this column must contain numbers",
             not_finite == NotFinite::kAccept ? "write nan if there is no result, or remove the row" : "");
  } else {
    complain(describe(number.fault, text) + " in column " + in_quotes(names_[column]),
             "this column must contain numbers", advice(number.fault));
  }
  return 0.0;
}

Vec3 CsvTable::vector(const std::array<std::size_t, 3>& columns) {
  const double x = number(columns[0]), y = number(columns[1]), z = number(columns[2]);
  return {x, y, z};
}

void CsvTable::complain(std::string what, std::string why, std::string suggestion) {
  complain_at(lines_.number(), std::move(what), std::move(why), std::move(suggestion));
}

void CsvTable::complain_at(std::size_t line, std::string what, std::string why, std::string suggestion) {
  problems_.add({lines_.file(), line, std::move(what), std::move(why), std::move(suggestion)});
}

}  // namespace exactff::text
