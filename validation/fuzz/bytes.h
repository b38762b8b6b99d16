// Reads the input of a fuzzer as a list of choices, from front to back.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace exactff::validation {

// Past the end every choice is 0, so that each prefix of an input is also a valid input.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }

  std::uint8_t next() {
    if (rest_.empty()) return 0;
    const std::uint8_t byte = rest_.front();
    rest_ = rest_.subspan(1);
    return byte;
  }
  // 0 .. count - 1; requires 0 < count <= 256.
  std::size_t below(std::size_t count) { return next() % count; }

  // The next eight bytes as a double, lowest byte first; 0 if they encode no number.
  double raw_double() {
    std::uint64_t bits = 0;
    for (int shift = 0; shift < 64; shift += 8) bits |= static_cast<std::uint64_t>(next()) << shift;
    const auto value = std::bit_cast<double>(bits);
    return std::isfinite(value) ? value : 0.0;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace exactff::validation
