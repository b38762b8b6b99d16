// The layout of a binary STL file: 80 bytes of any content, the number of triangles, and for each triangle 12 floats
// (normal and vertices) and 2 bytes of attributes, all little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "files/numpy.h"
#include "kernel/expect.h"

namespace exactff::formats {

struct StlLayout {
  static constexpr std::size_t kTitle = 80;
  static constexpr std::size_t kHead = 84;
  static constexpr std::size_t kTriangle = 50;

  // Requires kHead bytes.
  static std::size_t triangle_count(std::string_view bytes) {
    EXACTFF_EXPECT(bytes.size() >= kHead);
    std::uint32_t count = 0;
    files::read_little_endian(bytes.substr(kTitle), std::span(&count, 1));
    return count;
  }
};

}  // namespace exactff::formats
