#include "vtk/cells.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

namespace exactff::vtk {
namespace {

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

// Neighbouring cells of a lattice share their nodes.
class LatticeNodes {
 public:
  LatticeNodes(const Lattice& lattice, DataSet& data)
      : lattice_(lattice),
        data_(data),
        index_((static_cast<std::size_t>(lattice.size.u) + 1) * (static_cast<std::size_t>(lattice.size.v) + 1), kNone) {
  }

  void add(const GridCell& cell) {
    if (cell.column < 1 || cell.column > lattice_.size.u || cell.row < 1 || cell.row > lattice_.size.v) {
      throw std::invalid_argument("a receiver's cell lies outside its lattice");
    }
    for (const auto& [i, j] : {std::pair{cell.column - 1, cell.row - 1},
                               {cell.column, cell.row - 1},
                               {cell.column, cell.row},
                               {cell.column - 1, cell.row}}) {
      data_.corners.push_back(at(i, j));
    }
    end_cell(data_);
  }

 private:
  std::int64_t at(int i, int j) {
    std::int64_t& index = index_[static_cast<std::size_t>(j) * (static_cast<std::size_t>(lattice_.size.u) + 1) +
                                 static_cast<std::size_t>(i)];
    if (index == kNone) {
      index = add_point(data_, node(lattice_.corners, static_cast<double>(i) / lattice_.size.u,
                                    static_cast<double>(j) / lattice_.size.v));
    }
    return index;
  }

  const Lattice& lattice_;
  DataSet& data_;
  std::vector<std::int64_t> index_;
};

void append(std::vector<double>& list, const Vec3& v) { list.insert(list.end(), {v.x, v.y, v.z}); }
void append(std::vector<double>& list, const Rgb& c) { list.insert(list.end(), {c.r, c.g, c.b}); }

}  // namespace

std::vector<std::size_t> cell_order(std::span<const Receiver> receivers) {
  std::vector<std::size_t> order(receivers.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_partition(order, [&](std::size_t i) { return !receivers[i].cell; });
  return order;
}

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

namespace {

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

}  // namespace

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

}  // namespace exactff::vtk
