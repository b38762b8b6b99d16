// Lists and whole numbers as flags take them, and the patches that they name.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff::cli {

// The parts between the commas; one empty part of an empty text.
std::vector<std::string> split_list(const std::string& text);

// The whole text, in decimal digits; nothing where it is anything else or out of range.
template <class Whole>
std::optional<Whole> whole_number(std::string_view text) {
  Whole value{};
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end.ec != std::errc{} || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

// In the order of `texts`, each of which is a name, a comma list of names, or "all": every patch with area, in the
// order of the file. A patch of that very name wins, whether it is called "all" or has a comma. Throws InputError for a
// name that is unknown.
std::vector<Selection> selections_named(const Scene& scene, const std::vector<std::string>& texts);

}  // namespace exactff::cli
