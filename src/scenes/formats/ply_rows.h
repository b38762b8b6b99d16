// The rows of a PLY file, one for each vertex or face: lines of text, or binary values in either byte order.
//
// Both kinds have the same functions, in the order of a row's properties:
//   next()             goes to the next row; false if there is none
//   real(type)         reads a number; whole types are exact
//   whole(type)        reads a whole number
//   list_size(types)   reads the size of a list, never more than the file can hold
//   pass_over(property)
//   finish()           ends the row
//   place()            of the row, for messages
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "formats/ply_header.h"
#include "text/number_text.h"

namespace exactff::formats {

// A line is a row; blank lines are none. After a fault, the rest of the row reads as zeros.
class TextRows {
 public:
  TextRows(std::string_view bytes, const PlyHeader& header, MeshInput& input)
      : input_(input), lines_(bytes.substr(header.bytes), header.lines) {}

  bool next() {
    do {
      if (!lines_.next(line_)) return false;
      rest_ = text::trimmed(line_.text);
    } while (rest_.empty());
    sound_ = true;
    return true;
  }

  double real(PlyType) {
    const std::string_view word = take();
    if (!sound_) return 0.0;
    const text::ParsedNumber number = text::parse_number(word);
    if (number.fault != text::NumberFault::kNone)
      fail(describe(number.fault, word), "a coordinate is one exact number", advice(number.fault));
    return number.value;
  }

  std::int64_t whole(PlyType) {
    const std::string_view word = take();
    if (!sound_) return 0;
    const auto number = whole_number(word);
    if (!number) fail(text::in_quotes(word) + " is not a whole number", "it is an index or a count", "correct it");
    return number.value_or(0);
  }

  std::size_t list_size(const PlyProperty& list) {
    const std::int64_t size = whole(*list.count_type);
    if (size >= 0 && static_cast<std::uint64_t>(size) <= rest_.size()) return static_cast<std::size_t>(size);
    fail("a list of " + std::to_string(size) + " items", "the line does not hold them", "correct the count");
    return 0;
  }

  void pass_over(const PlyProperty& property) {
    const std::size_t words = property.count_type ? list_size(property) : 1;
    for (std::size_t i = 0; i < words && sound_; ++i) (void)take();
  }

  void finish() {
    if (!sound_ || text::trimmed(rest_).empty()) return;
    fail("a line has more values than the header declares", "each line is one vertex or one face",
         "correct the header or the line");
  }

  [[nodiscard]] FilePlace place() const { return at_line(line_.number); }
  [[nodiscard]] bool is_sound() const { return sound_; }

  // After the last row.
  void warn_about_rest() {
    if (next()) {
      input_.warn(place(), "the header declares fewer lines than the file has", "the others are ignored",
                  "are the counts in the header right?");
    } else {
      input_.warn_if_cut_off(lines_, line_.number);
    }
  }
  // The number of bytes that a row has at least: one digit and a blank or line end for each value.
  static std::size_t least_bytes(const PlyElement& element) { return 2 * element.properties.size(); }
  [[nodiscard]] std::size_t bytes_left() const { return lines_.bytes_left() + 1; }  // the last line may have no end

 private:
  std::string_view take() {
    const std::string_view word = sound_ ? text::take_word(rest_) : std::string_view{};
    if (sound_ && word.empty()) {
      fail("a line has fewer values than the header declares", "each line is one vertex or one face",
           "correct the header or the line");
    }
    return word;
  }
  void fail(std::string what, std::string why, std::string suggestion) {
    if (sound_) input_.fail(place(), std::move(what), std::move(why), std::move(suggestion));
    sound_ = false;
  }

  MeshInput& input_;
  text::PlainLines lines_;
  text::TextLine line_;
  std::string_view rest_;
  bool sound_ = true;
};

// Where a binary file ends too early or a list has no valid size, nothing after it can be read.
template <std::endian kOrder>
class BinaryRows {
 public:
  BinaryRows(std::string_view bytes, const PlyHeader& header, MeshInput& input)
      : input_(input), bytes_(bytes), at_(header.bytes) {}

  bool next() {
    row_ = at_;
    sound_ = true;
    return at_ < bytes_.size();
  }

  double real(PlyType type) {
    if (type == PlyType::kFloat32) return finite(take<float>());
    if (type == PlyType::kFloat64) return finite(take<double>());
    return static_cast<double>(whole(type));
  }

  std::int64_t whole(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return take<std::int8_t>();
      case PlyType::kUint8:
        return take<std::uint8_t>();
      case PlyType::kInt16:
        return take<std::int16_t>();
      case PlyType::kUint16:
        return take<std::uint16_t>();
      case PlyType::kInt32:
        return take<std::int32_t>();
      default:
        return take<std::uint32_t>();
    }
  }

  std::size_t list_size(const PlyProperty& list) {
    const std::size_t start = at_;
    const std::int64_t size = whole(*list.count_type);
    if (size >= 0 && static_cast<std::uint64_t>(size) <= bytes_left() / size_of(list.type))
      return static_cast<std::size_t>(size);
    input_.give_up(at_byte(start), "a list of " + std::to_string(size) + " items",
                   "only " + std::to_string(bytes_left()) + " bytes follow", "the file is damaged or incomplete");
  }

  void pass_over(const PlyProperty& property) {
    const std::size_t items = property.count_type ? list_size(property) : 1;
    require(items * size_of(property.type));
    at_ += items * size_of(property.type);
  }

  void finish() {}
  [[nodiscard]] FilePlace place() const { return at_byte(row_); }
  [[nodiscard]] bool is_sound() const { return sound_; }

  void warn_about_rest() {
    if (at_ == bytes_.size()) return;
    input_.warn(at_byte(at_), "the header declares fewer data than the file has", "the others are ignored",
                "are the counts in the header right?");
  }
  static std::size_t least_bytes(const PlyElement& element) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
      bytes += size_of(property.count_type.value_or(property.type));
    return bytes;
  }
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size() - at_; }

 private:
  void require(std::size_t bytes) {
    if (bytes <= bytes_left()) return;
    input_.give_up(at_byte(bytes_.size()), "the file ends too early", "the header declares more data",
                   "is the file complete?");
  }

  template <class T>
  T take() {
    require(sizeof(T));
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if constexpr (kOrder != std::endian::native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  double finite(double value) {
    if (std::isfinite(value)) return value;
    input_.fail(place(), "a coordinate is not a finite number", "a coordinate is one exact number",
                "give finite coordinates");
    sound_ = false;
    return 0.0;
  }

  MeshInput& input_;
  std::string_view bytes_;
  std::size_t at_;
  std::size_t row_ = 0;
  bool sound_ = true;
};

}  // namespace exactff::formats
