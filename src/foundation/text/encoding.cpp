#include "text/encoding.h"

#include <array>
#include <boost/locale/utf.hpp>
#include <cstdint>
#include <iterator>

namespace exactff::text {
namespace {

// The characters of the bytes 0x80 to 0x9F.
constexpr std::array<char32_t, 32> kWindows1252 = {0x20AC, 0x0081, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                                   0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0x008D, 0x017D, 0x008F,
                                                   0x0090, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                                   0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x009D, 0x017E, 0x0178};

}  // namespace

using Utf8 = boost::locale::utf::utf_traits<char>;

void append_utf8(std::string& text, char32_t code) { Utf8::encode(code, std::back_inserter(text)); }

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    if (!c.well_formed) return false;
    at += c.bytes;
  }
  return true;
}

std::string in_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string converted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    append_utf8(converted, byte >= 0x80 && byte < 0xA0 ? kWindows1252[byte - 0x80U] : byte);
  }
  return converted;
}

// --- Characters ---

Character character_at(std::string_view text, std::size_t at) {
  const auto* next = text.data() + at;
  const boost::locale::utf::code_point code = Utf8::decode(next, text.data() + text.size());
  if (!boost::locale::utf::is_valid_codepoint(code)) return {static_cast<unsigned char>(text[at]), 1, false};
  return {code, static_cast<std::size_t>(next - text.data()) - at, true};
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

// --- Base64 ---

namespace {

constexpr std::string_view kBase64Digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// Of a multiple of three bytes.
std::string encode(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size() / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return std::uint32_t{static_cast<unsigned char>(bytes[i + k])}; };
    const std::uint32_t three = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += kBase64Digits[three >> shift & 63U];
  }
  return text;
}

}  // namespace

std::string Base64::append(std::string_view bytes) {
  rest_ += bytes;
  const std::size_t whole = rest_.size() / 3 * 3;
  std::string text = encode(std::string_view(rest_).substr(0, whole));
  rest_.erase(0, whole);
  return text;
}

std::string Base64::finish() {
  const std::size_t missing = (3 - rest_.size() % 3) % 3;
  rest_.append(missing, '\0');
  std::string text = encode(rest_);
  text.replace(text.size() - missing, missing, missing, '=');
  rest_.clear();
  return text;
}

}  // namespace exactff::text
