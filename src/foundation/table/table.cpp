// Tables in memory, and their head as JSON.
#include "exactff/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "exactff/version.h"
#include "kernel/expect.h"
#include "table/csv.h"
#include "table/rows.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::table {
namespace {

using nlohmann::ordered_json;

constexpr std::array kTypes = {Type::kText, Type::kNumber, Type::kCount, Type::kFlag};
constexpr std::array kStrengths = {Strength::kGiven, Strength::kProved, Strength::kCertified, Strength::kStated,
                                   Strength::kEstimated};

template <class Word>
std::optional<Word> named(std::span<const Word> words, const ordered_json& object, const char* key) {
  const auto value = object.find(key);
  if (value == object.end() || !value->is_string()) return std::nullopt;
  for (const Word word : words) {
    if (value->get_ref<const std::string&>() == to_string(word)) return word;
  }
  return std::nullopt;
}

ordered_json json_of(const Column& column) {
  ordered_json json = {{"name", column.name}, {"type", to_string(column.type)}};
  if (!column.unit.empty()) json["unit"] = column.unit;
  json["strength"] = to_string(column.strength);
  if (column.key) json["key"] = true;
  return json;
}

std::optional<Column> column_of(const ordered_json& json) {
  if (!json.is_object() || !json.contains("name") || !json["name"].is_string()) return std::nullopt;
  const auto type = named<Type>(kTypes, json, "type");
  const auto strength = named<Strength>(kStrengths, json, "strength");
  if (!type || !strength) return std::nullopt;
  const auto unit = json.find("unit");
  return Column{json["name"].get<std::string>(), *type,
                unit != json.end() && unit->is_string() ? unit->get<std::string>() : std::string(), *strength,
                json.contains("key")};
}

std::optional<HeadValue> value_of(const ordered_json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  if (!json.is_array()) return std::nullopt;
  std::vector<std::string> list;
  for (const ordered_json& one : json) {
    if (!one.is_string()) return std::nullopt;
    list.push_back(one.get<std::string>());
  }
  return list;
}

template <class Value>
std::optional<Value> as(const HeadValue* value) {
  const Value* const found = value == nullptr ? nullptr : std::get_if<Value>(value);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

}  // namespace

std::string_view to_string(Type type) {
  return std::array{"text", "number", "count", "flag"}.at(static_cast<std::size_t>(type));
}

std::string_view to_string(Strength strength) {
  return std::array{"given", "proved", "certified", "stated", "estimated"}.at(static_cast<std::size_t>(strength));
}

// --- Heads ---

void Head::set(std::string_view name, HeadValue value) {
  if (const double* const number = std::get_if<double>(&value)) EXACTFF_EXPECT(std::isfinite(*number));
  for (auto& [known, old] : values_) {
    if (known != name) continue;
    old = std::move(value);
    return;
  }
  values_.emplace_back(name, std::move(value));
}

void Head::remove(std::string_view name) {
  std::erase_if(values_, [&](const auto& entry) { return entry.first == name; });
}

const HeadValue* Head::find(std::string_view name) const {
  const auto found = std::ranges::find(values_, name, &std::pair<std::string, HeadValue>::first);
  return found == values_.end() ? nullptr : &found->second;
}

std::optional<std::string> Head::text(std::string_view name) const { return as<std::string>(find(name)); }
std::optional<std::uint64_t> Head::count(std::string_view name) const { return as<std::uint64_t>(find(name)); }
bool Head::flag(std::string_view name) const { return as<bool>(find(name)).value_or(false); }
std::vector<std::string> Head::list(std::string_view name) const {
  return as<std::vector<std::string>>(find(name)).value_or(std::vector<std::string>());
}
std::optional<double> Head::number(std::string_view name) const {
  if (const auto whole = count(name)) return static_cast<double>(*whole);
  return as<double>(find(name));
}

std::string words_of(const HeadValue& value) {
  return std::visit(
      [](const auto& one) -> std::string {
        using Value = std::remove_cvref_t<decltype(one)>;
        if constexpr (std::same_as<Value, std::string>) {
          return one;
        } else if constexpr (std::same_as<Value, bool>) {
          return one ? "yes" : "no";
        } else if constexpr (std::same_as<Value, std::vector<std::string>>) {
          return text::enumerate(one);
        } else if constexpr (std::same_as<Value, double>) {
          return text::shortest(one);
        } else {
          return std::to_string(one);
        }
      },
      value);
}

std::vector<std::string> lines_of(const ParsedHead& head) {
  std::vector<std::string> lines = {text::program_version() + ' ' + head.kind};
  for (const auto& [name, value] : head.head.values()) lines.push_back(name + ": " + words_of(value));
  return lines;
}

std::string head_line(std::string_view kind, const Head& head, std::span<const Column> columns) {
  ordered_json json = {{"exactff", kVersion}, {"table", kind}};
  for (const auto& [name, value] : head.values()) {
    std::visit([&, &key = name](const auto& one) { json[key] = one; }, value);
  }
  ordered_json& list = json["columns"] = ordered_json::array();
  for (const Column& column : columns) list.push_back(json_of(column));
  return text::json_line(json);
}

std::optional<ParsedHead> parse_head(std::string_view text) {
  const ordered_json json = ordered_json::parse(text, nullptr, false);
  if (!json.is_object() || json.size() < 3 || json.begin().key() != "exactff") return std::nullopt;
  ParsedHead parsed;
  for (const auto& [name, value] : json.items()) {
    if (name == "columns") {
      if (!value.is_array()) return std::nullopt;
      for (const ordered_json& one : value) {
        const std::optional<Column> column = column_of(one);
        if (!column) return std::nullopt;
        parsed.columns.push_back(*column);
      }
    } else if (name == "table") {
      if (!value.is_string()) return std::nullopt;
      parsed.kind = value.get<std::string>();
    } else if (const std::optional<HeadValue> known = value_of(value)) {
      if (name != "exactff") parsed.head.set(name, *known);
    }
  }
  return parsed.kind.empty() || parsed.columns.empty() ? std::nullopt : std::optional(std::move(parsed));
}

// --- Rows ---

Table::Table(std::string kind, Head head, std::vector<Column> columns)
    : kind_(std::move(kind)), head_(std::move(head)), columns_(std::move(columns)) {
  for (const Column& column : columns_) {
    switch (column.type) {
      case Type::kText:
        values_.emplace_back(std::vector<std::string>());
        break;
      case Type::kNumber:
        values_.emplace_back(std::vector<double>());
        break;
      default:
        values_.emplace_back(std::vector<std::uint64_t>());
    }
  }
}

std::optional<std::size_t> Table::column(std::string_view name) const {
  const auto found = std::ranges::find(columns_, name, &Column::name);
  return found == columns_.end() ? std::nullopt : std::optional<std::size_t>(found - columns_.begin());
}

void Table::append(std::span<const Cell> row, std::size_t line) {
  EXACTFF_EXPECT(row.size() == columns_.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    const Cell& cell = row[i];
    switch (columns_[i].type) {
      case Type::kText:
        std::get<std::vector<std::string>>(values_[i])
            .emplace_back(cell.index() == 0 ? std::string_view() : std::get<std::string_view>(cell));
        break;
      case Type::kNumber:
        std::get<std::vector<double>>(values_[i])
            .push_back(cell.index() == 0 ? std::numeric_limits<double>::quiet_NaN() : std::get<double>(cell));
        break;
      case Type::kCount:
        std::get<std::vector<std::uint64_t>>(values_[i]).push_back(std::get<std::uint64_t>(cell));
        break;
      case Type::kFlag:
        std::get<std::vector<std::uint64_t>>(values_[i]).push_back(std::get<bool>(cell) ? 1 : 0);
        break;
    }
  }
  lines_.push_back(static_cast<std::uint32_t>(line));
}

Cell Table::at(std::size_t row, std::size_t column) const {
  switch (columns_[column].type) {
    case Type::kText:
      return std::string_view(texts(column)[row]);
    case Type::kNumber: {
      const double number = numbers(column)[row];
      return std::isnan(number) ? Cell() : Cell(number);
    }
    case Type::kCount:
      return counts(column)[row];
    default:
      return counts(column)[row] != 0;
  }
}

const std::vector<double>& Table::numbers(std::size_t column) const {
  return std::get<std::vector<double>>(values_.at(column));
}
const std::vector<std::string>& Table::texts(std::size_t column) const {
  return std::get<std::vector<std::string>>(values_.at(column));
}
const std::vector<std::uint64_t>& Table::counts(std::size_t column) const {
  return std::get<std::vector<std::uint64_t>>(values_.at(column));
}

// --- Tables from lists of values ---

Columns joined(std::initializer_list<Columns> lists) {
  Columns all;
  for (const Columns& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

Columns columns(std::string_view names, const Column& like) {
  Columns list;
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(','), names.size());
    list.push_back(like);
    list.back().name = names.substr(0, end);
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return list;
}

Rows::Rows(std::string kind, Head head, std::initializer_list<Columns> columns)
    : table_(std::move(kind), std::move(head), joined(columns)), texts_(table_.columns().size()) {}

void Rows::add(const Cell& cell) {
  cells_.push_back(cell);
  if (const auto* const text = std::get_if<std::string_view>(&cells_.back())) {
    cells_.back() = std::string_view(texts_[cells_.size() - 1] = *text);
  }
  if (cells_.size() < texts_.size()) return;
  table_.append(cells_);
  cells_.clear();
}

void Rows::add_whole(std::uint64_t value) {
  const Type type = table_.columns()[cells_.size()].type;
  if (type == Type::kText) return add(std::string_view(std::to_string(value)));
  add(type == Type::kNumber ? Cell(static_cast<double>(value)) : Cell(value));
}

}  // namespace exactff::table
