// Hashes and checksums.
#pragma once

#include <bit>
#include <boost/crc.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "exactff/geometry.h"
#include "text/phrases.h"

namespace exactff::text {

// 64-bit FNV-1a, a hash that distinguishes inputs. The byte order is the same on every machine.
class Fnv1a {
 public:
  void add(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) add_byte(static_cast<unsigned char>(value >> shift));
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Vec3& p) {
    for (const double c : {p.x, p.y, p.z}) add(c);
  }
  // Adds no terminator: later input must make clear where the text ended.
  void add_bytes(std::string_view text) {
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
  }
  void add_byte(unsigned char byte) { state_ = (state_ ^ byte) * 0x100000001b3U; }

  [[nodiscard]] std::uint64_t value() const { return state_; }
  [[nodiscard]] std::string digits() const { return hexadecimal(state_, 16); }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

// --- Crc32 ---

// The CRC-32 checksum of journals and truth files.

// Of the two texts, one after the other, as 8 hexadecimal digits.
inline std::string crc32_digits(std::string_view first, std::string_view second) {
  boost::crc_32_type crc;
  crc.process_bytes(first.data(), first.size());
  crc.process_bytes(second.data(), second.size());
  return hexadecimal(crc.checksum(), 8);
}

}  // namespace exactff::text
