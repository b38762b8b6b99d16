#include "text/base64.h"

#include <cstdint>

namespace exactff::text {
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
