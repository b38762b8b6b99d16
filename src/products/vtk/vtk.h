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
void write_faces(const Scene& scene, const std::vector<Field>& fields, const std::vector<std::string>& about,
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

}  // namespace exactff::vtk
