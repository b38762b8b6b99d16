// VTK's XML, as its "VTK File Formats" document describes it. Each array is one base64 text: the number of its bytes as
// a UInt64, then its bytes. Offsets are those of the ends of cells. In PolyData, vertices and polygons are two lists,
// and arrays of cells hold the values of all vertices first.
#include "vtk/data_set.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string_view>

#include "files/numpy.h"
#include "files/parallel.h"
#include "text/encoding.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "vtk/vtk.h"

namespace exactff::vtk {
namespace {

constexpr int kVertex = 1, kTriangle = 5, kPolygon = 7, kQuadrilateral = 9;  // VTK's types of cells

template <class T>
constexpr std::string_view kTypeName = {};
template <>
constexpr std::string_view kTypeName<double> = "Float64";
template <>
constexpr std::string_view kTypeName<std::int64_t> = "Int64";
template <>
constexpr std::string_view kTypeName<std::uint8_t> = "UInt8";

// For an attribute: control characters would be normalised away.
std::string attribute(std::string_view text) { return text::html(text::printable(text)); }

std::string count(const char* what, std::size_t number) {
  return std::string(" NumberOf") + what + "=\"" + std::to_string(number) + '"';
}

class Document {
 public:
  Document(files::WholeFile& file, const Hooks& hooks) : file_(file), hooks_(hooks) {}

  void line(const std::string& text) { file_.append(text + '\n'); }

  template <class T>
  void numbers(const std::string& name, std::size_t components, std::span<const T> values) {
    open(kTypeName<T>, name, components, values.size() / components);
    text::Base64 base64;
    const std::uint64_t bytes = values.size_bytes();
    file_.append(base64.append(files::little_endian(std::span(&bytes, 1))));
    constexpr std::size_t kPiece = 1 << 16;
    for (std::size_t i = 0; i < values.size(); i += kPiece) {
      file_.append(base64.append(files::little_endian(values.subspan(i, std::min(kPiece, values.size() - i)))));
    }
    file_.append(base64.finish());
    line("\n</DataArray>");
  }

  // Texts end with a zero byte each.
  void texts(const std::string& name, const std::vector<std::string>& values) {
    std::string all;
    for (const std::string& value : values) all += text::printable(value) + '\0';
    open("String", name, 1, values.size());
    text::Base64 base64;
    const std::uint64_t bytes = all.size();
    file_.append(base64.append(files::little_endian(std::span(&bytes, 1))));
    file_.append(base64.append(all));
    file_.append(base64.finish());
    line("\n</DataArray>");
  }

 private:
  void open(std::string_view type, const std::string& name, std::size_t components, std::size_t tuples) {
    files::require_not_cancelled(hooks_);
    // meshio makes a matrix of an array that says that it has one component.
    const std::string vectors = components == 1 ? "" : " NumberOfComponents=\"" + std::to_string(components) + '"';
    line("<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + '"' + vectors + count("Tuples", tuples) +
         " format=\"binary\">");
  }

  files::WholeFile& file_;
  const Hooks& hooks_;
};

// Distinct as they stand in the file, where control characters are escaped.
class Names {
 public:
  std::string take(const std::string& name) {
    std::string free = attribute(name);
    for (int k = 2; !taken_.insert(free).second; ++k) free = attribute(name + ' ' + std::to_string(k));
    return free;
  }

 private:
  std::set<std::string> taken_;
};

void put_arrays(const std::vector<Array>& arrays, Format format, Document& document) {
  Names names;
  for (const Array& array : arrays) {
    if (const auto* texts = std::get_if<std::vector<std::string>>(&array.values)) {
      if (format == Format::kPolygons) document.texts(names.take(array.name), *texts);
      continue;
    }
    const auto put = [&]<class T>(const std::vector<T>& values) {
      if constexpr (!std::is_same_v<T, std::string>) {
        document.numbers(names.take(array.name), array.components, std::span<const T>(values));
      }
    };
    std::visit(put, array.values);
  }
}

// Ends are counted from the beginning of the list.
void put_cells(const DataSet& data, std::size_t first, std::size_t last, Document& document) {
  const auto begin = first == 0 ? 0 : data.ends[first - 1], end = last == 0 ? 0 : data.ends[last - 1];
  std::vector<std::int64_t> ends(data.ends.begin() + static_cast<std::ptrdiff_t>(first),
                                 data.ends.begin() + static_cast<std::ptrdiff_t>(last));
  for (std::int64_t& one : ends) one -= begin;
  document.numbers(
      "connectivity", 1,
      std::span(data.corners).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
  document.numbers("offsets", 1, std::span<const std::int64_t>(ends));
}

void put_types(const DataSet& data, Document& document) {
  std::vector<std::uint8_t> types;
  std::int64_t begin = 0;
  for (const std::int64_t end : data.ends) {
    const std::int64_t corners = end - begin;
    types.push_back(static_cast<std::uint8_t>(corners == 1   ? kVertex
                                              : corners == 3 ? kTriangle
                                              : corners == 4 ? kQuadrilateral
                                                             : kPolygon));
    begin = end;
  }
  document.numbers("types", 1, std::span<const std::uint8_t>(types));
}

void put_points(const DataSet& data, Document& document) {
  std::vector<double> coordinates;
  for (const Vec3& p : data.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  document.line("<Points>");
  document.numbers("Points", 3, std::span<const double>(coordinates));
  document.line("</Points>");
}

void put_polygons(const DataSet& data, Document& document) {
  const std::size_t cells = data.ends.size();
  document.line("<Piece" + count("Points", data.points.size()) + count("Verts", data.vertices) + count("Lines", 0) +
                count("Strips", 0) + count("Polys", cells - data.vertices) + '>');
  put_points(data, document);
  document.line("<Verts>");
  put_cells(data, 0, data.vertices, document);
  document.line("</Verts>\n<Polys>");
  put_cells(data, data.vertices, cells, document);
  document.line("</Polys>");
}

void put_unstructured(const DataSet& data, Document& document) {
  document.line("<Piece" + count("Points", data.points.size()) + count("Cells", data.ends.size()) + '>');
  put_points(data, document);
  document.line("<Cells>");
  put_cells(data, 0, data.ends.size(), document);
  put_types(data, document);
  document.line("</Cells>");
}

}  // namespace

Format format_of(const std::filesystem::path& file) {
  const std::string extension = text::in_lower_case(file.extension().string());
  if (extension == ".vtp") return Format::kPolygons;
  if (extension == ".vtu") return Format::kUnstructured;
  text::refuse(file, "the name does not end in .vtp or .vtu", "programs tell VTK's files apart by their names",
               "write .vtp for polygons (ParaView, PyVista), or .vtu for an unstructured grid (meshio as well)");
}

void append(const DataSet& data, Format format, files::WholeFile& file, const Hooks& hooks) {
  const std::string type = format == Format::kPolygons ? "PolyData" : "UnstructuredGrid";
  Document document(file, hooks);
  document.line("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<VTKFile type=\"" + type +
                "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + type + '>');
  if (format == Format::kPolygons && !data.of_file.empty()) {
    document.line("<FieldData>");
    put_arrays(data.of_file, format, document);
    document.line("</FieldData>");
  }
  format == Format::kPolygons ? put_polygons(data, document) : put_unstructured(data, document);
  document.line("<CellData" + (data.shown.empty() ? "" : " Scalars=\"" + attribute(data.shown) + '"') + '>');
  put_arrays(data.of_cells, format, document);
  document.line("</CellData>\n</Piece>\n</" + type + ">\n</VTKFile>");
}

}  // namespace exactff::vtk
