#include "text/characters.h"

namespace exactff::text {

namespace {

struct Lead {
  std::size_t bytes = 0;  // 0: not the beginning of a character
  char32_t least = 0;     // smaller codes have shorter forms
};

Lead lead_of(unsigned char byte) {
  if (byte < 0x80) return {1, 0};
  if (byte < 0xC2) return {};
  if (byte < 0xE0) return {2, 0x80};
  if (byte < 0xF0) return {3, 0x800};
  if (byte < 0xF5) return {4, 0x10000};
  return {};
}

bool is_scalar_value(char32_t code) { return code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF); }

}  // namespace

Character character_at(std::string_view text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const Character broken{first, 1, false};
  const Lead lead = lead_of(first);
  if (lead.bytes == 0 || at + lead.bytes > text.size()) return broken;
  char32_t code = lead.bytes == 1 ? first : first & (0x7FU >> lead.bytes);
  for (std::size_t i = 1; i < lead.bytes; ++i) {
    const auto next = static_cast<unsigned char>(text[at + i]);
    if ((next & 0xC0U) != 0x80U) return broken;
    code = (code << 6U) | (next & 0x3FU);
  }
  if (code < lead.least || !is_scalar_value(code)) return broken;
  return {code, lead.bytes, true};
}

std::string_view beginning(std::string_view text, std::size_t bytes) {
  std::size_t end = 0;
  while (end < text.size()) {
    const std::size_t next = end + character_at(text, end).bytes;
    if (next > bytes) break;
    end = next;
  }
  return text.substr(0, end);
}

bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xFFFE || code == 0xFFFF;
}

}  // namespace exactff::text
