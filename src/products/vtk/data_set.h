// Points, cells and arrays, and the XML file that holds them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/progress.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
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

// --- Receivers and scenes as cells ---

// The receivers in the order of their cells: those without a cell on a lattice first.
[[nodiscard]] std::vector<std::size_t> cell_order(std::span<const Receiver> receivers);

// The cells, and arrays that say which receiver each one is.
[[nodiscard]] DataSet cells_of(const Scene& scene, std::span<const Receiver> receivers,
                               const std::vector<std::size_t>& order);

// The pieces of the faces, with patch, face and material.
[[nodiscard]] DataSet cells_of(const Scene& scene);

}  // namespace exactff::vtk
