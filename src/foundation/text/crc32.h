// The CRC-32 checksum of journals and truth files.
#pragma once

#include <boost/crc.hpp>
#include <string>
#include <string_view>

#include "text/fnv1a.h"

namespace exactff::text {

// Of the two texts, one after the other, as 8 hexadecimal digits.
inline std::string crc32_digits(std::string_view first, std::string_view second) {
  boost::crc_32_type crc;
  crc.process_bytes(first.data(), first.size());
  crc.process_bytes(second.data(), second.size());
  return hexadecimal(crc.checksum(), 8);
}

}  // namespace exactff::text
