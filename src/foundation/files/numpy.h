// NumPy's file formats. Sources: numpy.lib.format, "Format Version 1.0"; numpy.savez; "APPNOTE.TXT - .ZIP File Format
// Specification", 4.3.
//
// .npy: one array. A header of text, then the elements, little-endian, the last index running fastest (C order).
// .npz: arrays with names, a zip archive of .npy files that are stored, not compressed.
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/file.h"

namespace exactff::files {

// The bytes of numbers, lowest byte first.
template <class T>
[[nodiscard]] std::string little_endian(std::span<const T> values) {
  std::string bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  if constexpr (std::endian::native == std::endian::big) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) std::reverse(&bytes[i], &bytes[i] + sizeof(T));
  }
  return bytes;
}

// The inverse. Requires as many bytes as the values have.
template <class T>
void read_little_endian(std::string_view bytes, std::span<T> values) {
  if (values.empty()) return;  // memcpy takes no null pointer
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  if constexpr (std::endian::native == std::endian::big) {
    for (T& value : values) std::reverse(reinterpret_cast<char*>(&value), reinterpret_cast<char*>(&value + 1));
  }
}

// --- one array, written ---

// NumPy's name of the element type.
template <class T>
inline constexpr std::string_view kNpyType = std::same_as<T, double>          ? "<f8"
                                             : std::same_as<T, float>         ? "<f4"
                                             : std::same_as<T, std::int32_t>  ? "<i4"
                                             : std::same_as<T, std::int64_t>  ? "<i8"
                                             : std::same_as<T, std::uint64_t> ? "<u8"
                                             : std::same_as<T, std::uint8_t>  ? "|u1"
                                                                              : "";

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

// --- one array, read ---

struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;  // in C order; may be infinite or NaN
};

[[nodiscard]] bool is_npy(std::string_view bytes);
// The same of a file. False if it cannot be read.
[[nodiscard]] bool is_npy_file(const std::filesystem::path& path);

// Of float64 or float32, either byte order, in C or Fortran order. Throws InputError, with what to do, for a file that
// cannot be read, holds other elements, or is not as long as its shape says.
[[nodiscard]] NpyArray read_npy(const std::filesystem::path& path);

// --- several arrays ---

class NpzFile {
 public:
  // The file appears at `path`, and replaces another one there, when commit() returns. The constructor throws
  // InputError if the file cannot be written.
  explicit NpzFile(const std::filesystem::path& path, FailureAdvice advice = {}) : file_(path, std::move(advice)) {}

  // Requires a name that was not used. Throws InputError if the file grows beyond 4 GiB.
  template <class T>
  void add(std::string_view name, std::span<const std::size_t> shape, std::span<const T> values) {
    add_bytes(name, npy_header(kNpyType<T>, shape), little_endian(values));
  }
  template <class T>
  void add(std::string_view name, const std::vector<T>& values) {
    const std::size_t count = values.size();
    add(name, std::span(&count, 1), std::span<const T>(values));
  }
  // An array of texts, of characters (Unicode). Text that is not UTF-8 is read as Windows-1252.
  void add_texts(std::string_view name, const std::vector<std::string>& texts);
  // One text as an array without axes, of bytes.
  void add_word(std::string_view name, std::string_view word);

  void commit();

 private:
  struct Entry {
    std::string name;
    std::uint32_t checksum = 0, size = 0, offset = 0;
  };
  void add_bytes(std::string_view name, const std::string& header, const std::string& elements);
  void require_room(std::size_t bytes) const;
  void append(const std::string& bytes);

  WholeFile file_;
  std::uint64_t written_ = 0;
  std::vector<Entry> entries_;
};

// Reads such an archive: stored arrays of one axis, or words. Throws InputError, with what to do, for another file, one
// that is damaged, and an array that is missing or holds other elements.
class NpzReader {
 public:
  explicit NpzReader(const std::filesystem::path& path);

  template <class T>
  [[nodiscard]] std::vector<T> numbers(std::string_view name) const {
    const std::string_view bytes = elements(name, kNpyType<T>);
    std::vector<T> values(bytes.size() / sizeof(T));
    read_little_endian(bytes, std::span<T>(values));
    return values;
  }
  [[nodiscard]] std::vector<std::string> texts(std::string_view name) const;  // in UTF-8
  [[nodiscard]] std::string word(std::string_view name) const;

 private:
  struct Array {
    std::string name;
    std::string_view header, elements;
  };
  [[nodiscard]] const Array* find(std::string_view name) const;
  // Of this type, or of one that begins with it.
  [[nodiscard]] const Array& array(std::string_view name, std::string_view type) const;
  [[nodiscard]] std::string_view elements(std::string_view name, std::string_view type) const {
    return array(name, type).elements;
  }
  [[noreturn]] void damaged(const std::string& what) const;

  std::filesystem::path path_;
  std::string bytes_;
  std::vector<Array> arrays_;
};

}  // namespace exactff::files
