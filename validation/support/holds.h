// Whether a text, such as a message, has a part.
#pragma once

#include <string>

namespace exactff::validation {

[[nodiscard]] inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace exactff::validation
