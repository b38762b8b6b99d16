#include "vtk/cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "kernel/vec.h"

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

void append(std::vector<double>& list, const Vec3& v) { list.insert(list.end(), {v.x, v.y, v.z}); }
void append(std::vector<double>& list, const Rgb& c) { list.insert(list.end(), {c.r, c.g, c.b}); }

}  // namespace

std::vector<std::size_t> cell_order(std::span<const Receiver> receivers) {
  std::vector<std::size_t> order(receivers.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return !receivers[i].cell; });
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
