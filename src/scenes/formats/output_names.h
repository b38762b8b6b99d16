// Names as a format can hold them.
#pragma once

#include <string>
#include <vector>

#include "formats/writers.h"

namespace exactff::formats {

// No format holds line breaks, zero bytes, blanks at the ends of a name, or an empty name.
struct NameRules {
  bool one_word = false;          // no blanks
  char comment = '\0';            // begins a comment
  bool only_before_word = false;  // ... only at the beginning of a word
  bool joins_lines = false;       // a backslash at the end of a line joins it with the next
};

// The names in their order, with '_' for what the format does not hold. They stay distinct. Tells what has changed;
// `noun` says what is named: "patch".
[[nodiscard]] std::vector<std::string> output_names(std::vector<std::string> names, const NameRules& rules,
                                                    const std::string& noun, Losses& losses);

[[nodiscard]] std::vector<std::string> patch_names(const Scene& scene);
// True if all faces are in one patch with the name of faces that belong to none.
[[nodiscard]] bool has_only_default_patch(const Scene& scene);

// The name as the format can hold it.
[[nodiscard]] std::string fit_name(std::string name, const NameRules& rules);

}  // namespace exactff::formats
