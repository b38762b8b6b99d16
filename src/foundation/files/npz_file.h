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

}  // namespace exactff::files
