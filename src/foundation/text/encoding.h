// Names in other encodings than UTF-8. All outputs are UTF-8, whatever came in.
#pragma once

#include <string>
#include <string_view>

namespace exactff::text {

[[nodiscard]] bool is_utf8(std::string_view text);

// Well-formed UTF-8 is not changed. Any other text is taken as a whole for Windows-1252, which contains the printable
// characters of Latin-1; its five bytes without a character become control characters. Different texts that are not
// UTF-8 stay different.
[[nodiscard]] std::string in_utf8(std::string_view text);

// Appends the character of this code, which is at most U+10FFFF.
void append_utf8(std::string& text, char32_t code);

}  // namespace exactff::text
