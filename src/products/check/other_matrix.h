// Matrices of view factors as other programs write them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

// A matrix without names: the order of rows and columns is all there is.
struct NumberGrid {
  std::string file;
  std::string kind;  // "View3D's output", for messages
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;        // row by row; may be infinite or NaN
  std::vector<std::uint32_t> lines;  // of each value; empty if the file has no lines
  std::vector<double> areas;         // of the rows; empty if the file has none
  std::uint32_t line_of_areas = 0;
};

enum class OtherKind { kList, kNamed, kNumbers, kView3d, kNpy };
// By the content. Throws InputError if the file cannot be read, or is of a kind that is never read.
[[nodiscard]] OtherKind kind_of(const std::filesystem::path& file, const CandidateColumns& columns);

[[nodiscard]] NumberGrid read_numbers(const std::filesystem::path& file);
[[nodiscard]] NumberGrid read_view3d_output(const std::filesystem::path& file);
[[nodiscard]] NumberGrid read_npy_grid(const std::filesystem::path& file);

// A table with the names of columns in its first line, and in each line a name and its numbers. Rows are receivers,
// columns are sources.
[[nodiscard]] Candidate read_named(const std::filesystem::path& file);

}  // namespace exactff::check
