// Bytes as base64 text (RFC 4648), piece by piece.
#pragma once

#include <string>
#include <string_view>

namespace exactff::text {

class Base64 {
 public:
  // The text of the bytes so far that no later byte can change and that has not been returned yet.
  [[nodiscard]] std::string append(std::string_view bytes);
  // The rest.
  [[nodiscard]] std::string finish();

 private:
  std::string rest_;  // fewer than three bytes, between calls
};

}  // namespace exactff::text
