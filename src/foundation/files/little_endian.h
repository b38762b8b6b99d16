// The bytes of numbers, lowest byte first.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <string>

namespace exactff::files {

template <class T>
[[nodiscard]] std::string little_endian(std::span<const T> values) {
  std::string bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  if constexpr (std::endian::native == std::endian::big) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) std::reverse(&bytes[i], &bytes[i] + sizeof(T));
  }
  return bytes;
}

}  // namespace exactff::files
