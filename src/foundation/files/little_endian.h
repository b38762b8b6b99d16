// The bytes of numbers, lowest byte first.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace exactff::files {

template <class T>
[[nodiscard]] std::string little_endian(std::span<const T> values) {
  std::string bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  if constexpr (std::endian::native == std::endian::big) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) std::reverse(&bytes[i], &bytes[i] + sizeof(T));
  }
  return bytes;
}

// The inverse. Requires as many bytes as the values have.
template <class T>
void read_little_endian(std::string_view bytes, std::span<T> values) {
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  if constexpr (std::endian::native == std::endian::big) {
    for (T& value : values) std::reverse(reinterpret_cast<char*>(&value), reinterpret_cast<char*>(&value + 1));
  }
}

}  // namespace exactff::files
