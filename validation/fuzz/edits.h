// Interprets the input of a fuzzer as edits of a text, such as a journal, that is generated anew in every version. So
// the meaning of an input does not depend on the numbers in the text.
#pragma once

#include <string>

#include "fuzz/bytes.h"

namespace exactff::validation {

// Each edit inserts or changes a byte, removes, doubles or moves a part, or cuts off the end. Repeated until the
// choices end.
inline std::string edited(std::string text, Bytes& bytes) {
  constexpr std::size_t kMostBytes = 1 << 16;
  while (!bytes.done() && text.size() < kMostBytes) {
    const std::size_t action = bytes.below(6);
    const std::size_t at = (bytes.next() + std::size_t{256} * bytes.next()) % (text.size() + 1);
    const std::uint8_t amount = bytes.next();
    const std::string part = text.substr(at, amount);
    if (action == 0) text.insert(at, 1, static_cast<char>(amount));
    if (action == 1 && at < text.size()) text[at] = static_cast<char>(amount);
    if (action == 2) text.erase(at, amount);
    if (action == 3) text.insert(at, part);
    if (action == 4) text = text.substr(0, at) + text.substr(at + part.size()) + part;
    if (action == 5) text.resize(at);
  }
  return text;
}

}  // namespace exactff::validation
