// The words that files have for what is known of view factors.
#pragma once

#include <optional>
#include <string_view>

#include "exactff/view_factors.h"

namespace exactff::matrix {

// The claim, way or limit of this text.
template <class Word>
std::optional<Word> named(std::string_view word) {
  for (int i = 0; !to_string(static_cast<Word>(i)).empty(); ++i) {
    if (word == to_string(static_cast<Word>(i))) return static_cast<Word>(i);
  }
  return std::nullopt;
}

// The claims for two kinds of estimates that files had before `way` was a column.
inline constexpr std::string_view kOldByCells = "topology-proved", kOldByPoints = "statistical";

inline bool is_old_claim(std::string_view word) { return word == kOldByCells || word == kOldByPoints; }

// Old ones count as estimated.
inline std::optional<Claim> claim_named(std::string_view word) {
  return is_old_claim(word) ? Claim::kEstimated : named<Claim>(word);
}

}  // namespace exactff::matrix
