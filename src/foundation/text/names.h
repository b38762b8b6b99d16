// Lists of names, suggestions for a misspelt one, and names with a number.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "text/number_text.h"

namespace exactff::text {

inline std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// Numbers names from 0 in the order of their first use.
class NameList {
 public:
  std::uint32_t number_of(const std::string& name) {
    const auto [found, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    return found->second;
  }
  [[nodiscard]] std::optional<std::uint32_t> find(const std::string& name) const {
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(names_); }

 private:
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

// "a, b, c"
template <class Name>
std::string joined(const std::vector<Name>& names, std::string_view separator = ", ") {
  std::string list;
  for (const std::string_view name : names) {
    if (!list.empty()) list += separator;
    list += name;
  }
  return list;
}

// Insertions, deletions and replacements between two words, or any number above `limit` where there are more.
inline std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > limit) return limit + 1;
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    std::size_t least = row[0];
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
      least = std::min(least, row[j + 1]);
    }
    if (least > limit) return least;
  }
  return row.back();
}

// The `count` names closest to `wanted`, ignoring case, the closest first, ties in the given order. Only the beginnings
// of long names are compared, so that the time is linear in the number of names.
inline std::vector<std::string_view> nearest_names(const std::vector<std::string_view>& names, std::string_view wanted,
                                                   std::size_t count) {
  constexpr std::size_t kLongestCompared = 64;
  const std::string sought = in_lower_case(wanted.substr(0, kLongestCompared));
  std::vector<std::pair<std::size_t, std::size_t>> best;  // distance, place; sorted
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t limit = best.size() < count ? 2 * kLongestCompared : best.back().first;
    const std::pair ranked(edit_distance(in_lower_case(names[i].substr(0, kLongestCompared)), sought, limit), i);
    best.insert(std::upper_bound(best.begin(), best.end(), ranked), ranked);
    if (best.size() > count) best.pop_back();
  }
  std::vector<std::string_view> nearest;
  for (const auto& [distance, i] : best) nearest.push_back(names[i]);
  return nearest;
}

// --- Numbered name ---

// Names of the form NAME:k.

// Split at the last colon.
struct NumberedName {
  std::string patch;
  std::uint64_t number = 0;
};

inline std::optional<NumberedName> numbered_name(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto number = whole_number<std::uint64_t>(name.substr(colon + 1));
  return number ? std::optional(NumberedName{std::string(name.substr(0, colon)), *number}) : std::nullopt;
}

// The same of NAME/k, too: of patches that are made from geometry.
inline std::optional<NumberedName> part_name(std::string_view name) {
  std::string copy(name);
  if (const std::size_t last = copy.find_last_of(":/"); last != std::string::npos) copy[last] = ':';
  return numbered_name(copy);
}

}  // namespace exactff::text
