// NumPy's file format .npy, version 1.0: a header of text, then the elements, little-endian, the last index running
// fastest (C order). Source: numpy.lib.format, "Format Version 1.0".
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "files/file.h"
#include "files/little_endian.h"

namespace exactff::files {

// NumPy's name of the element type.
template <class T>
inline constexpr std::string_view kNpyType = {};
template <>
inline constexpr std::string_view kNpyType<double> = "<f8";
template <>
inline constexpr std::string_view kNpyType<float> = "<f4";
template <>
inline constexpr std::string_view kNpyType<std::int32_t> = "<i4";
template <>
inline constexpr std::string_view kNpyType<std::int64_t> = "<i8";
template <>
inline constexpr std::string_view kNpyType<std::uint64_t> = "<u8";
template <>
inline constexpr std::string_view kNpyType<std::uint8_t> = "|u1";

// The bytes before the elements. No shape is one number; an extent of 0 is an array without elements. Throws InputError
// for more than 65,535 bytes, which is some thousand axes.
[[nodiscard]] std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

// The number of elements of the array in this file; throws InputError if it is more than a std::size_t holds.
[[nodiscard]] std::size_t npy_count(const std::filesystem::path& path, std::span<const std::size_t> shape);

// An array that is written element by element, in C order.
template <class T>
class NpyFile {
  static_assert(!kNpyType<T>.empty(), "name the type above");

 public:
  // The file appears at `path`, and replaces another one there, when commit() returns. The constructor throws
  // InputError if the file cannot be written.
  NpyFile(const std::filesystem::path& path, std::span<const std::size_t> shape, FailureAdvice advice = {})
      : missing_(npy_count(path, shape)), file_(path, std::move(advice)) {
    file_.append(npy_header(kNpyType<T>, shape));
  }

  void append(std::span<const T> values) {
    require_room(missing_ >= values.size());
    missing_ -= values.size();
    constexpr std::size_t kPiece = 1 << 16;  // elements
    for (std::size_t i = 0; i < values.size(); i += kPiece) {
      file_.append(little_endian(values.subspan(i, std::min(kPiece, values.size() - i))));
    }
  }
  void append(const T& value) { append(std::span<const T>(&value, 1)); }

  // Requires as many elements as the shape says.
  void commit() {
    require_room(missing_ == 0);
    file_.commit();
  }

 private:
  static void require_room(bool holds) {
    if (!holds) throw std::logic_error("the elements of an array are not as many as its shape says");
  }

  std::size_t missing_;
  WholeFile file_;
};

// Writes the whole array, or nothing.
template <class T>
void write_npy(const std::filesystem::path& path, std::span<const std::size_t> shape, std::span<const T> values,
               FailureAdvice advice = {}) {
  NpyFile<T> file(path, shape, std::move(advice));
  file.append(values);
  file.commit();
}

}  // namespace exactff::files
