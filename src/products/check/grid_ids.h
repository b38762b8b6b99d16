// Names of the cells of a grid.
#pragma once

#include <algorithm>
#include <string>

namespace exactff::check {

// "r7c12" of "12,7", and "NAME:k/r7c12" of "NAME:k/12,7", which are the names in files of older versions. Any other id
// stays as it is.
inline std::string current_id(std::string id) {
  const std::size_t slash = id.rfind('/'), start = slash == std::string::npos ? 0 : slash + 1;
  const std::size_t comma = id.find(',', start);
  if (comma == std::string::npos) return id;
  const auto is_number = [&](std::size_t first, std::size_t last) {
    return first < last &&
           std::all_of(id.begin() + static_cast<std::ptrdiff_t>(first), id.begin() + static_cast<std::ptrdiff_t>(last),
                       [](char c) { return c >= '0' && c <= '9'; });
  };
  if (!is_number(start, comma) || !is_number(comma + 1, id.size())) return id;
  return id.substr(0, start) + 'r' + id.substr(comma + 1) + 'c' + id.substr(start, comma - start);
}

}  // namespace exactff::check
