// The names that completion offers for a kind of value.
#pragma once

#include <string>
#include <vector>

namespace exactff::cli {

// `kind` is the placeholder of an option or the name of a positional argument: EXPERIMENT, FAMILY, METHOD, or SCENE
// (the generated ones, with their @). Empty for any other kind.
[[nodiscard]] std::vector<std::string> known_words(const std::string& kind);

}  // namespace exactff::cli
