#include "vtk/vtk.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "files/numpy.h"
#include "files/parallel.h"
#include "kernel/vec.h"
#include "text/encoding.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::vtk {

namespace {

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
void append(std::vector<double>& list, const Vec3& v) { list.insert(list.end(), {v.x, v.y, v.z}); }
void append(std::vector<double>& list, const Rgb& c) { list.insert(list.end(), {c.r, c.g, c.b}); }

template <class Triple>
std::vector<double> numbers_of(const std::vector<Triple>& triples) {
  std::vector<double> list;
  for (const Triple& one : triples) append(list, one);
  return list;
}

// --- Files ---

// VTK's XML, as its "VTK File Formats" document describes it. Each array is one base64 text: the number of its bytes as
// a UInt64, then its bytes. Offsets are those of the ends of cells. In PolyData, vertices and polygons are two lists,
// and arrays of cells hold the values of all vertices first.

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
    open(kTypeName<T>, name, components, values.size() / components, values.size_bytes());
    constexpr std::size_t kPiece = 1 << 16;
    for (std::size_t i = 0; i < values.size(); i += kPiece) {
      file_.append(base64_.append(files::little_endian(values.subspan(i, std::min(kPiece, values.size() - i)))));
    }
    close();
  }

  // Texts end with a zero byte each.
  void texts(const std::string& name, const std::vector<std::string>& values) {
    std::string all;
    for (const std::string& value : values) all += text::printable(value) + '\0';
    open("String", name, 1, values.size(), all.size());
    file_.append(base64_.append(all));
    close();
  }

 private:
  void open(std::string_view type, const std::string& name, std::size_t components, std::size_t tuples,
            std::uint64_t bytes) {
    files::require_not_cancelled(hooks_);
    // meshio makes a matrix of an array that says that it has one component.
    const std::string vectors = components == 1 ? "" : " NumberOfComponents=\"" + std::to_string(components) + '"';
    line("<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + '"' + vectors + count("Tuples", tuples) +
         " format=\"binary\">");
    base64_ = {};
    file_.append(base64_.append(files::little_endian(std::span<const std::uint64_t>(&bytes, 1))));
  }
  void close() {
    file_.append(base64_.finish());
    line("\n</DataArray>");
  }

  files::WholeFile& file_;
  const Hooks& hooks_;
  text::Base64 base64_;
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
  const std::vector<double> coordinates = numbers_of(data.points);
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

// By the extension; throws InputError for another one than .vtp and .vtu.
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

// --- Cells ---

constexpr std::int64_t kNone = -1;

// A corner beyond the range of doubles was rounded to infinity.
double finite(double coordinate) {
  constexpr double kMost = std::numeric_limits<double>::max();
  return std::clamp(coordinate, -kMost, kMost);
}

// The bilinear map of the corners at (s, t). Weights add up to 1, so nothing overflows.
Vec3 node(const std::array<Vec3, 4>& p, double s, double t) {
  const auto at = [&](double Vec3::*c) {
    return finite((1.0 - t) * ((1.0 - s) * finite(p[0].*c) + s * finite(p[1].*c)) +
                  t * ((1.0 - s) * finite(p[3].*c) + s * finite(p[2].*c)));
  };
  return {at(&Vec3::x), at(&Vec3::y), at(&Vec3::z)};
}

void end_cell(DataSet& data) { data.ends.push_back(static_cast<std::int64_t>(data.corners.size())); }

std::int64_t add_point(DataSet& data, const Vec3& point) {
  data.points.push_back(point);
  return static_cast<std::int64_t>(data.points.size()) - 1;
}

// A place on a lattice: s along u and t along v, from 0 to 1.
struct LatticePoint {
  double s = 0.0, t = 0.0;
};
using Outline = std::vector<LatticePoint>;

// Positive if p lies left of the line from a to b.
double side(const LatticePoint& a, const LatticePoint& b, const LatticePoint& p) {
  return (b.s - a.s) * (p.t - a.t) - (b.t - a.t) * (p.s - a.s);
}

// The part of a convex polygon on the left of the line from a to b (Sutherland and Hodgman 1974). An estimate: it is
// for the eye.
Outline left_part(const Outline& polygon, const LatticePoint& a, const LatticePoint& b) {
  Outline part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const LatticePoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double of_p = side(a, b, p), of_q = side(a, b, q);
    if (of_p >= 0.0) part.push_back(p);
    if ((of_p > 0.0 && of_q < 0.0) || (of_p < 0.0 && of_q > 0.0)) {
      const double share = of_p / (of_p - of_q);
      part.push_back({p.s + share * (q.s - p.s), p.t + share * (q.t - p.t)});
    }
  }
  return part;
}

// Coordinates are halved: the difference of any two doubles is then finite.
Vec3 half_difference(const Vec3& a, const Vec3& b) {
  const auto at = [&](double Vec3::*c) { return 0.5 * finite(a.*c) - 0.5 * finite(b.*c); };
  return {at(&Vec3::x), at(&Vec3::y), at(&Vec3::z)};
}

// The outline on the rectangle of the lattice, scaled so that products neither overflow nor vanish.
Outline outline_of(const Lattice& lattice) {
  Outline outline;
  const Vec3 e = half_difference(lattice.corners[1], lattice.corners[0]);
  const Vec3 f = half_difference(lattice.corners[3], lattice.corners[0]);
  const auto share = [&](const Vec3& v, const Vec3& axis) {
    const double scale = kernel::max_norm(axis);
    const auto part = [&](double a, double b) { return (a / scale) * (b / scale); };
    return (part(v.x, axis.x) + part(v.y, axis.y) + part(v.z, axis.z)) /
           (part(axis.x, axis.x) + part(axis.y, axis.y) + part(axis.z, axis.z));
  };
  for (const Vec3& corner : lattice.convex_outline) {
    const Vec3 v = half_difference(corner, lattice.corners[0]);
    outline.push_back({share(v, e), share(v, f)});
  }
  return outline;
}

// Neighbouring cells of a lattice share their nodes.
class LatticeNodes {
 public:
  LatticeNodes(const Lattice& lattice, DataSet& data)
      : lattice_(lattice),
        data_(data),
        outline_(outline_of(lattice)),
        index_((static_cast<std::size_t>(lattice.size.u) + 1) * (static_cast<std::size_t>(lattice.size.v) + 1), kNone) {
  }

  void add(const GridCell& cell) {
    if (cell.column < 1 || cell.column > lattice_.size.u || cell.row < 1 || cell.row > lattice_.size.v) {
      throw std::invalid_argument("a receiver's cell lies outside its lattice");
    }
    if (add_cut(cell)) return;
    for (const auto& [i, j] : {std::pair{cell.column - 1, cell.row - 1},
                               {cell.column, cell.row - 1},
                               {cell.column, cell.row},
                               {cell.column - 1, cell.row}}) {
      data_.corners.push_back(at(i, j));
    }
    end_cell(data_);
  }

 private:
  [[nodiscard]] double s(int i) const { return static_cast<double>(i) / lattice_.size.u; }
  [[nodiscard]] double t(int j) const { return static_cast<double>(j) / lattice_.size.v; }

  // A cell that reaches over the outline is cut. Returns false for any other cell, and where rounding leaves nothing.
  bool add_cut(const GridCell& cell) {
    const Outline whole = {{s(cell.column - 1), t(cell.row - 1)},
                           {s(cell.column), t(cell.row - 1)},
                           {s(cell.column), t(cell.row)},
                           {s(cell.column - 1), t(cell.row)}};
    Outline part = whole;
    bool is_cut = false;
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const LatticePoint &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
      is_cut = is_cut || std::ranges::any_of(whole, [&](const LatticePoint& p) { return side(a, b, p) < 0.0; });
      part = left_part(part, a, b);
    }
    if (!is_cut || part.size() < 3) return false;
    for (const LatticePoint& p : part) data_.corners.push_back(add_point(data_, node(lattice_.corners, p.s, p.t)));
    end_cell(data_);
    return true;
  }

  std::int64_t at(int i, int j) {
    std::int64_t& index = index_[static_cast<std::size_t>(j) * (static_cast<std::size_t>(lattice_.size.u) + 1) +
                                 static_cast<std::size_t>(i)];
    if (index == kNone) {
      index = add_point(data_, node(lattice_.corners, s(i), t(j)));
    }
    return index;
  }

  const Lattice& lattice_;
  DataSet& data_;
  const Outline outline_;  // only if it cuts cells
  std::vector<std::int64_t> index_;
};

// The receivers in the order of their cells: those without a cell on a lattice first.
std::vector<std::size_t> cell_order(std::span<const Receiver> receivers) {
  std::vector<std::size_t> order(receivers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return !receivers[i].cell; });
  return order;
}

// The cells, and arrays that say which receiver each one is.
DataSet cells_of(const Scene& scene, std::span<const Receiver> receivers, const std::vector<std::size_t>& order) {
  DataSet data;
  std::map<const Lattice*, LatticeNodes> lattices;
  std::vector<std::int64_t> numbers, patches, rows, columns;
  std::vector<double> points, normals;
  std::vector<std::string> ids, on;
  for (const std::size_t i : order) {
    const Receiver& receiver = receivers[i];
    if (receiver.cell) {
      const Lattice& lattice = *receiver.cell->lattice;
      lattices.try_emplace(&lattice, lattice, data).first->second.add(*receiver.cell);
    } else {
      data.corners.push_back(add_point(data, receiver.point));
      end_cell(data);
      ++data.vertices;
    }
    numbers.push_back(static_cast<std::int64_t>(i));
    patches.push_back(receiver.on.empty() ? kNone
                                          : static_cast<std::int64_t>(index_of(scene.face(receiver.on.front()).patch)));
    rows.push_back(receiver.cell ? receiver.cell->row : 0);
    columns.push_back(receiver.cell ? receiver.cell->column : 0);
    append(points, receiver.point);
    append(normals, receiver.normal);
    ids.push_back(receiver.id.empty() ? std::to_string(i + 1) : receiver.id);
    on.push_back(scene.name_of(receiver.on));
  }
  data.of_cells = {
      {"receiver", 1, std::move(numbers)}, {"id", 1, std::move(ids)},        {"on", 1, std::move(on)},
      {"patch", 1, std::move(patches)},    {"row", 1, std::move(rows)},      {"column", 1, std::move(columns)},
      {"point", 3, std::move(points)},     {"normal", 3, std::move(normals)}};
  return data;
}

// Adds only the vertices that are used: others would enlarge the picture.
void add_pieces(const Scene& scene, DataSet& data) {
  std::vector<std::int64_t> index(scene.vertices().size(), kNone);
  for (const Piece& piece : scene.pieces()) {
    for (const std::uint32_t v : scene.corners(piece)) {
      if (index[v] == kNone) index[v] = add_point(data, scene.vertices()[v]);
      data.corners.push_back(index[v]);
    }
    end_cell(data);
  }
}

// The pieces of the faces, with patch, face and material.
DataSet cells_of(const Scene& scene) {
  DataSet data;
  add_pieces(scene, data);
  std::vector<std::int64_t> patches, faces, materials;
  std::vector<std::string> names, patch_names, material_names;
  std::vector<double> kd, ke;
  std::vector<std::uint8_t> transparent;
  for (const Piece& piece : scene.pieces()) {
    const Face& face = scene.face(piece.face);
    patches.push_back(static_cast<std::int64_t>(index_of(face.patch)));
    faces.push_back(face.number);
    names.push_back(scene.name_of(piece.face));
    materials.push_back(static_cast<std::int64_t>(index_of(face.material)));
    append(kd, scene.material(face.material).reflectance);
    append(ke, scene.material(face.material).radiosity);
    transparent.push_back(face.transparent ? 1 : 0);
  }
  for (const Patch& patch : scene.patches()) patch_names.push_back(patch.name);
  for (const Material& material : scene.materials()) material_names.push_back(material.name);
  data.of_cells = {
      {"patch", 1, std::move(patches)},          {"face", 1, std::move(faces)}, {"name", 1, std::move(names)},
      {"material", 1, std::move(materials)},     {"Kd", 3, std::move(kd)},      {"Ke", 3, std::move(ke)},
      {"transparent", 1, std::move(transparent)}};
  data.of_file = {{"patch names", 1, std::move(patch_names)}, {"material names", 1, std::move(material_names)}};
  data.shown = "patch";
  return data;
}

// --- Fields ---

template <class T>
std::vector<T> in_order(const std::vector<T>& values, std::size_t components, const std::vector<std::size_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(components * order.size());
  for (const std::size_t i : order) {
    for (std::size_t c = 0; c < components; ++c) sorted.push_back(values[i * components + c]);
  }
  return sorted;
}

void require_tuples(const Field& field, std::size_t count) {
  const std::size_t numbers = std::visit([](const auto& values) { return values.size(); }, field.values);
  if (numbers == field.components * count) return;
  throw std::invalid_argument("a field has not a value for each receiver or face");
}

// `order`: of the receiver or face whose value each cell shows; `count` of them have one.
void add_fields(const std::vector<Field>& fields, std::size_t count, const std::vector<std::size_t>& order,
                const std::vector<std::string>& about, DataSet& data) {
  for (const Field& field : fields) {
    require_tuples(field, count);
    Array& array = data.of_cells.emplace_back(Array{field.name, field.components, {}});
    std::visit([&](const auto& values) { array.values = in_order(values, field.components, order); }, field.values);
  }
  if (!fields.empty()) data.shown = fields.front().name;
  if (!about.empty()) data.of_file.push_back({"about", 1, about});
}

void add(std::vector<Rgb>& sum, const std::vector<Rgb>& more) {
  sum.resize(more.size());
  for (std::size_t i = 0; i < more.size(); ++i) {
    sum[i] = {sum[i].r + more[i].r, sum[i].g + more[i].g, sum[i].b + more[i].b};
  }
}

}  // namespace

Field field_of_faces(const Scene& scene, std::string name, std::span<const Selection> selections,
                     std::size_t components, const std::function<double(std::size_t, std::size_t)>& value) {
  std::vector<double> values(components * scene.faces().size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < selections.size(); ++i) {
    for (const FaceId face : scene.faces_of(selections[i])) {
      for (std::size_t c = 0; c < components; ++c) values[components * index_of(face) + c] = value(i, c);
    }
  }
  return {std::move(name), components, std::move(values)};
}

std::vector<Field> fields_of(std::vector<SourceValues> sources) {
  const bool several = sources.size() > 1;
  std::vector<Field> fields;
  std::vector<Rgb> sum;
  for (SourceValues& one : sources) {
    const auto name = [&](const char* quantity) {
      return several ? std::string(quantity) + " (" + one.source + ')' : std::string(quantity);
    };
    fields.push_back({name("exact"), 1, std::move(one.exact)});
    fields.push_back({name("lower"), 1, std::move(one.lower)});
    fields.push_back({name("upper"), 1, std::move(one.upper)});
    fields.push_back({name("status"), 1, std::move(one.status)});
    if (!one.visible_fraction.empty()) fields.push_back({name("visible fraction"), 1, std::move(one.visible_fraction)});
    if (!one.gradient.empty()) fields.push_back({name("gradient"), 3, numbers_of(one.gradient)});
    fields.push_back({name("radiosity"), 3, numbers_of(one.radiosity)});
    if (several) add(sum, one.radiosity);
  }
  if (several) fields.push_back({"radiosity", 3, numbers_of(sum)});
  return fields;
}

std::filesystem::path scene_file(const std::filesystem::path& file) {
  return file.parent_path() / (file.stem().string() + "_scene" + file.extension().string());
}

void require_extension(const std::filesystem::path& file) { static_cast<void>(format_of(file)); }

void write_faces(const Scene& scene, const std::vector<Field>& fields, const std::vector<std::string>& about,
                 const std::filesystem::path& file, const Hooks& hooks) {
  const Format format = format_of(file);
  files::WholeFile cells(file);
  std::vector<std::size_t> face_of_cell;
  for (const Piece& piece : scene.pieces()) face_of_cell.push_back(index_of(piece.face));
  DataSet data = cells_of(scene);
  add_fields(fields, scene.faces().size(), face_of_cell, about, data);
  append(data, format, cells, hooks);
  files::require_not_cancelled(hooks);
  cells.commit();
}

void write(const Content& content, const std::filesystem::path& file, const Hooks& hooks) {
  const Format format = format_of(file);
  files::WholeFile receivers(file), scene(scene_file(file));
  const std::vector<std::size_t> order = cell_order(content.receivers);
  DataSet data = cells_of(*content.scene, content.receivers, order);
  add_fields(content.fields, order.size(), order, content.about, data);
  append(data, format, receivers, hooks);
  append(cells_of(*content.scene), format, scene, hooks);
  files::require_not_cancelled(hooks);
  receivers.commit();
  scene.commit();
}

}  // namespace exactff::vtk
