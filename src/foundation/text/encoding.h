// Encodings of text: names that are not UTF-8, UTF-8 character by character, and base64. All outputs are UTF-8,
// whatever came in.
#pragma once

#include <cstddef>
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

// --- Characters ---

// UTF-8, character by character. Names and paths may hold any bytes; nothing here assumes that they are UTF-8.

// A well-formed character (Unicode 15, table 3-7: neither overlong nor a surrogate nor beyond U+10FFFF), or one byte
// that is not part of such a character.
struct Character {
  char32_t code = 0;  // the byte itself if it is not well-formed
  std::size_t bytes = 1;
  bool well_formed = false;
};

// The character that begins at text[at]; at < text.size().
[[nodiscard]] Character character_at(std::string_view text, std::size_t at);

// The longest prefix of at most `bytes` bytes that does not split a character.
[[nodiscard]] std::string_view beginning(std::string_view text, std::size_t bytes);

// Characters that control the output instead of being visible: C0 and C1 controls, DEL, line and paragraph separators,
// those that change the direction of the following text (U+202A to U+202E, U+2066 to U+2069), and the two that XML
// forbids (U+FFFE, U+FFFF).
[[nodiscard]] bool is_control(char32_t code);

// --- Base64 ---

// Bytes as base64 text (RFC 4648), piece by piece.

class Base64 {
 public:
  // The text of the bytes so far that no later byte can change and that has not been returned yet.
  [[nodiscard]] std::string append(std::string_view bytes);
  // The rest.
  [[nodiscard]] std::string finish();

 private:
  std::string rest_;  // fewer than three bytes, between calls
};

}  // namespace exactff::text
