#include "table/rows.h"

#include <algorithm>

namespace exactff::table {

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
