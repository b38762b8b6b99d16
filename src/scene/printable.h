// Text from files and command lines, made fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace exactff {

// Control characters become question marks: a name in a hostile file could otherwise steer the terminal, and a line
// break would make two messages out of one.
inline std::string printable(std::string_view text) {
  std::string shown(text);
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return shown;
}

}  // namespace exactff
