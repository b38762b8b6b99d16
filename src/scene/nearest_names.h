// Which names somebody may have meant.
#pragma once

#include <algorithm>
#include <cctype>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

namespace exactff {

// Insertions, deletions and replacements between two words, case apart.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

// The `count` names closest to `wanted`, the closest first, equals in the order given.
inline std::vector<std::string_view> nearest_names(const std::vector<std::string_view>& names, std::string_view wanted,
                                                   std::size_t count) {
  constexpr std::size_t kLongestCompared = 64;  // of a name; keeps the distances cheap
  wanted = wanted.substr(0, kLongestCompared);
  std::vector<std::pair<std::size_t, std::size_t>> ranked;
  for (std::size_t i = 0; i < names.size(); ++i) {
    ranked.emplace_back(edit_distance(names[i].substr(0, kLongestCompared), wanted), i);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string_view> nearest;
  for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) nearest.push_back(names[ranked[i].second]);
  return nearest;
}

}  // namespace exactff
