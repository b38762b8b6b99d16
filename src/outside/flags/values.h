// Parses the values of flags: lists, whole numbers, names of patches, and three numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"

namespace exactff::flags {

// The parts between the commas. An empty text has one empty part.
std::vector<std::string> split_list(const std::string& text);

// Parses the whole text as decimal digits. Returns nothing for any other text or a value out of range.
template <class Whole>
std::optional<Whole> whole_number(std::string_view text) {
  Whole value{};
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end.ec != std::errc{} || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

// A check of a flag's value.
[[nodiscard]] std::string is_positive(const std::string& text);

// What the help of such a flag says.
inline constexpr const char* kNamesHelp = "; can be repeated, or separate names by commas; * ? [...] as in file names";

// In the order of `texts`. Each of them is a name or pattern, which may stand for several patches (Scene::select_all),
// a comma list of them, or "all": every patch with area, in the order of the file. A patch, or the cells of a divided
// one, with exactly the given name has priority, even if its name is "all" or contains a comma. What a pattern matches
// is left out if it is among the selections before. Throws InputError for an unknown name.
std::vector<Selection> selections_named(const Scene& scene, const std::vector<std::string>& texts);

// Takes "sky" out of the texts, if it is among them and is not the name of a patch.
bool take_sky(const Scene& scene, std::vector<std::string>& texts);

// Whether "all" is among them and means every patch.
bool names_all(const Scene& scene, const std::vector<std::string>& texts);

// For selections_named(). The help says `meaning`, then how several are named, then `more`.
void add_names(CLI::App& app, const std::string& flag, std::vector<std::string>& names, const std::string& meaning,
               const std::string& more = "");
void add_threads(CLI::App& app, int& threads);

// The flags that are given, each preceded by a blank and quoted for a shell, without those that `left_out` names.
[[nodiscard]] std::string command_words(const CLI::App& command, const std::vector<std::string>& left_out = {});

// Three numbers as given; empty texts if the flag was not. CLI11 always gives an array all its words, so "-.5" is no
// flag.
using ThreeNumbers = std::array<std::string, 3>;
[[nodiscard]] inline bool is_given(const ThreeNumbers& numbers) { return !numbers.front().empty(); }

CLI::Option* add_vector_option(CLI::App& app, const std::string& flag, ThreeNumbers& numbers,
                               const std::string& meaning, const std::string& type = "X Y Z");

// Parses finite doubles with correct rounding. The InputError for other texts names the flag.
[[nodiscard]] Vec3 vector_of(const ThreeNumbers& numbers, const std::string& flag);

}  // namespace exactff::flags
