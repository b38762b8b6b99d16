// Reads NumPy's files of one array of numbers (npy_file.h has the format).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace exactff::files {

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

}  // namespace exactff::files
