// Letters of dots, for captions in pictures.
#pragma once

#include <cstdint>
#include <string_view>

namespace exactff::render {

inline constexpr int kLetterWidth = 6;    // with the gap
inline constexpr int kLetterHeight = 11;  // with the gap

// Whether the letter has a dot there. Characters that are not ASCII have none.
[[nodiscard]] bool has_dot(char letter, int column, int row);

}  // namespace exactff::render
