// Results as 64-bit words, for a journal that the same machine reads again.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace exactff::work {

class WordWriter {
 public:
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(std::uint64_t word) {
    char bytes[sizeof word];
    std::memcpy(bytes, &word, sizeof word);
    bytes_.append(bytes, sizeof word);
  }
  void put(std::string_view text) {
    put(std::uint64_t{text.size()});
    bytes_.append(text);
    bytes_.append((8 - text.size() % 8) % 8, '\0');
  }
  void put(const std::vector<double>& values) {
    put(std::uint64_t{values.size()});
    for (const double value : values) put(value);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Missing words at the end read as 0. `complete` is false if words were missing or were left unread.
class WordReader {
 public:
  explicit WordReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t word() {
    std::uint64_t result = 0;
    if (bytes_.size() < sizeof result) {
      torn_ = true;
      return 0;
    }
    std::memcpy(&result, bytes_.data(), sizeof result);
    bytes_.remove_prefix(sizeof result);
    return result;
  }
  // Reads a value in 0 .. count - 1, such as an enumerator. Any other word counts as torn.
  [[nodiscard]] std::uint64_t below(std::uint64_t count) {
    const std::uint64_t result = word();
    if (result < count) return result;
    torn_ = true;
    return 0;
  }
  [[nodiscard]] double number() { return std::bit_cast<double>(word()); }
  [[nodiscard]] std::string text() {
    const std::uint64_t size = word();
    if (size > bytes_.size() || (size + 7) / 8 * 8 > bytes_.size()) {
      torn_ = true;
      return {};
    }
    const std::string result(bytes_.substr(0, size));
    bytes_.remove_prefix((size + 7) / 8 * 8);
    return result;
  }
  [[nodiscard]] std::vector<double> numbers() {
    const std::uint64_t count = word();
    if (count > bytes_.size() / sizeof count) {
      torn_ = true;
      return {};
    }
    std::vector<double> values;
    while (values.size() < count) values.push_back(number());
    return values;
  }
  [[nodiscard]] bool torn() const { return torn_; }
  [[nodiscard]] bool complete() const { return !torn_ && bytes_.empty(); }

 private:
  std::string_view bytes_;
  bool torn_ = false;
};

}  // namespace exactff::work
