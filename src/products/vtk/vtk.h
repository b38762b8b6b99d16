// Files for ParaView, VTK and PyVista: values at receivers, and the scene, as polygons in space.
//
// The format is VTK's XML: polygons (.vtp), or an unstructured grid (.vtu), which meshio reads as well. Arrays are
// base64 text within the XML, little-endian, without compression.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/jobs.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "files/file.h"

namespace exactff::vtk {

// A number or a vector for each receiver. Names should be distinct; a number is appended to one that is not.
struct Field {
  std::string name;
  std::size_t components = 1;
  std::variant<std::vector<double>, std::vector<std::uint8_t>> values;  // `components` of them for each receiver
};

// The exact values of one source, each list with an entry for each receiver.
struct SourceValues {
  std::string source;
  std::vector<double> exact, lower, upper;
  std::vector<std::uint8_t> status;      // 0 certified, 1 zero, 2 underflow, 3 not certified (Status)
  std::vector<double> visible_fraction;  // empty: left out
  std::vector<Rgb> radiosity;            // rho B_s F
  std::vector<Vec3> gradient = {};       // empty: left out
};
// "exact", "lower", "upper", "status", "visible fraction", "gradient" and "radiosity". If there are several sources,
// the name of the source follows, "exact (lamp)", and "radiosity" is the sum, added in the order of the sources.
[[nodiscard]] std::vector<Field> fields_of(std::vector<SourceValues> sources);

struct Content {
  const Scene* scene = nullptr;
  std::span<const Receiver> receivers;
  std::vector<Field> fields;
  std::vector<std::string> about;  // where the values are from, in lines
};

// Writes two files: the receivers to `file`, and the scene to scene_file(file). A receiver that is the cell of a grid
// becomes the quadrilateral of its cell on the lattice (Lattice::corners), cut by a convex outline; any other one
// becomes a vertex. Cells are in the order of the receivers, except that vertices come first; the array "receiver"
// counts from 0. The scene's cells are the pieces of its faces. Arrays of text (names, `about`) are in .vtp files only:
// meshio cannot read them. Each file appears complete or not at all. Throws InputError if a file cannot be written, and
// Cancelled if the hooks cancel.
void write(const Content& content, const std::filesystem::path& file, const Hooks& hooks = {});

// Writes the scene alone, with values at its faces, if any: fields have their numbers for each face of the scene, by
// index. Throws as `write` does.
void write_faces(const Scene& scene, const std::vector<Field>& fields, std::vector<std::string> about,
                 const std::filesystem::path& file, const Hooks& hooks = {});

// "map_scene.vtp" for "map.vtp".
[[nodiscard]] std::filesystem::path scene_file(const std::filesystem::path& file);

// Throws InputError unless the name ends in .vtp or .vtu.
void require_extension(const std::filesystem::path& file);

// --- Numbers of patches and faces as a field of the scene's faces ---

// For write_faces: number c of a face is value(i, c) of the last selection i that has the face, and NaN if none has it.
[[nodiscard]] Field field_of_faces(const Scene& scene, std::string name, std::span<const Selection> selections,
                                   std::size_t components,
                                   const std::function<double(std::size_t i, std::size_t c)>& value);

// --- Points, cells and arrays, and the XML file that holds them ---

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
