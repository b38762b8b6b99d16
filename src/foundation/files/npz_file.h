// NumPy's file format .npz: arrays with names, a zip archive of .npy files that are stored, not compressed.
// Sources: numpy.savez; "APPNOTE.TXT - .ZIP File Format Specification", 4.3.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/file.h"
#include "files/npy_file.h"

namespace exactff::files {

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

  [[nodiscard]] bool has(std::string_view name) const { return find(name) != nullptr; }
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
