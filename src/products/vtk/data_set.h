// Points, cells and arrays, and the XML file that holds them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/progress.h"
#include "files/file.h"

namespace exactff::vtk {

struct Array {
  std::string name;
  std::size_t components = 1;
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::uint8_t>, std::vector<std::string>>
      values;
};

// A cell of one corner is a vertex, any other one a polygon.
struct DataSet {
  std::vector<Vec3> points;
  std::vector<std::int64_t> corners;  // indices of points, cell by cell
  std::vector<std::int64_t> ends;     // of each cell in `corners`
  std::size_t vertices = 0;           // so many cells, the first ones, are vertices
  std::vector<Array> of_cells;
  std::vector<Array> of_file;
  std::string shown;  // the array that colours the cells at first; may be empty
};

enum class Format { kPolygons, kUnstructured };
// By the extension; throws InputError for another one than .vtp and .vtu.
[[nodiscard]] Format format_of(const std::filesystem::path& file);

void append(const DataSet& data, Format format, files::WholeFile& file, const Hooks& hooks);

}  // namespace exactff::vtk
