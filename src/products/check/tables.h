// Shared by those who read truths and candidates and match their rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactff/check.h"
#include "matrix/other_programs.h"
#include "text/names.h"

namespace exactff::check {

using text::NameList;

inline constexpr std::string_view kSuite = "suite";  // the kind of a truth of questions

// The receivers of the truth with their areas, and its sources without the further ones, in their order.
[[nodiscard]] matrix::Order order_of(const Truth& truth);

// Rows of a truth by receiver and source.
using RowKey = std::pair<std::string_view, std::uint32_t>;
struct HashOfRow {
  std::size_t operator()(const RowKey& key) const {
    return std::hash<std::string_view>{}(key.first) ^ (key.second * std::size_t{0x9E3779B97F4A7C15});
  }
};
using RowIndex = std::unordered_map<RowKey, std::uint32_t, HashOfRow>;

// The values of a column; null if the table lacks it.
[[nodiscard]] const std::vector<double>* numbers_of(const table::Table& table, std::string_view column);
[[nodiscard]] const std::vector<std::string>* texts_of(const table::Table& table, std::string_view column);
// --- Words ---

// What a key is called in sentences: "row" and "column" of a matrix, else its name.
[[nodiscard]] std::string word_of(const std::string& key);
// " of source 'light'", or empty if sources have no names.
[[nodiscard]] std::string of_source(const Truth& truth, const std::string& source);

}  // namespace exactff::check
