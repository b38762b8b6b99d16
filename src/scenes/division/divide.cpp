// A scene cut into cells, each a patch.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "division/cells.h"
#include "division/cut_points.h"
#include "division/edge_cuts.h"
#include "exactff/scene.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/extent.h"
#include "scene/scene_data.h"
#include "text/numbered_name.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

using division::CutPoints;
using division::EdgeCuts;
using division::Polygon;
using Rings = std::vector<std::vector<std::uint32_t>>;

// An estimate of the number of a piece's cells and of their points along edges.
double expected_cells(const Scene& scene, const Piece& piece, double length) {
  const std::span<const std::uint32_t> corners = scene.corners(piece);
  const auto at = [&](std::size_t c) {
    const Vec3& origin = scene.vertices()[corners.front()];
    return division::difference_over(scene.vertices()[corners[c % corners.size()]], origin, length);
  };
  Vec3 twice_area;
  double perimeter = 0.0;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    twice_area = kernel::sum(twice_area, kernel::cross(at(c), at(c + 1)));
    perimeter += kernel::distance(at(c), at(c + 1));
  }
  return 0.5 * kernel::distance(twice_area, {}) + perimeter;
}

double expected_cells(const Scene& scene, double length) {
  double sum = 0.0;
  for (const Piece& piece : scene.pieces()) sum += expected_cells(scene, piece, length);
  return sum;
}

void require_possible(const Scene& scene, double length) {
  constexpr double kMostCells = 4e6, kLeastShare = 0x1p-32;
  constexpr double kLeastLength = 0x1p21 * std::numeric_limits<double>::denorm_min();  // as for a share of 2^-32
  if (!(length > 0.0) || !std::isfinite(length)) {
    text::refuse("a scene cannot be divided into cells of length " + text::shortest(length),
                 "it is a positive length in the scene's unit",
                 "give the largest length that a side of a cell may have");
  }
  if (const double cells = expected_cells(scene, length); !(cells <= kMostCells)) {
    const std::string about = std::isfinite(cells) ? "about " + text::short_number(cells) : "more than 1e308";
    text::refuse("divided by " + text::shortest(length) + ", the scene has " + about + " cells",
                 "at most " + text::short_number(kMostCells) + " are made", "give a larger length");
  }
  if (length / extent(scene).largest < kLeastShare || length < kLeastLength) {
    text::refuse("the length " + text::shortest(length) + " is too small for the scene's coordinates",
                 "corners of cells are rounded to doubles, which are too far apart there", "give a larger length");
  }
}

// A face of the new scene.
struct Cell {
  FaceId face{};  // that it was cut from
  Rings rings;
};

using CutPatch = std::pair<std::string, std::vector<Cell>>;  // with its name

// The cells of NAME are found by their names (Scene::select_all), so no other patch may be called as one of them.
void require_names_of_no_cells(const std::vector<CutPatch>& patches) {
  std::map<std::string, bool, std::less<>> is_cut;
  for (const auto& [name, cells] : patches) is_cut[name] = cells.size() > 1;
  for (const auto& [name, cells] : patches) {
    for (auto parts = text::numbered_name(name); parts; parts = text::numbered_name(parts->patch)) {
      const auto whole = is_cut.find(parts->patch);
      if (whole == is_cut.end() || !(whole->second || cells.size() > 1)) continue;
      text::refuse("divided, the patch " + text::in_quotes(name, text::kShownName) + " would count as cells of " +
                       text::in_quotes(whole->first, text::kShownName),
                   "cells are named NAME:k, and NAME means all of them", "rename one of the two patches");
    }
  }
}

class Division {
 public:
  Division(const Scene& scene, double length)
      : scene_(scene), points_(scene.vertices(), length), cuts_(scene, points_) {}

  DividedScene run() {
    std::vector<CutPatch> patches;
    for (const Patch& patch : scene_.patches()) patches.emplace_back(patch.name, cells_of(patch));
    std::erase_if(patches, [](const auto& patch) { return patch.second.empty(); });
    require_names_of_no_cells(patches);
    SceneBuilder builder = start();
    for (const auto& [name, cells] : patches) {
      for (std::size_t k = 0; k < cells.size(); ++k) {
        add(builder, cells.size() == 1 ? name : name + ':' + std::to_string(k + 1), cells[k]);
      }
    }
    const double deviation = std::max(points_.largest_displacement(), largest_distance_);
    return {builder.build().with_flipped(flipped_).with_transparent(transparent_), faces_cut_, added_, deviation};
  }

 private:
  std::vector<Cell> cells_of(const Patch& patch) {
    std::vector<Cell> cells;
    for (const FaceId face : patch.faces) add_cells_of(face, cells);
    return cells;
  }

  void add_cells_of(FaceId id, std::vector<Cell>& cells) {
    const Face& face = scene_.face(id);
    if (face.piece_count == 0) return;
    const std::size_t before = cells.size();
    if (face.shape == FaceShape::kPlanar && !division::is_wide(face.rings.front(), points_)) {
      cells.push_back({id, face.rings});
      return;
    }
    for (const Piece& piece : scene_.pieces_of(id)) add_cells_of(piece, cells);
    if (cells.size() > before + 1) ++faces_cut_;
  }

  void add_cells_of(const Piece& piece, std::vector<Cell>& cells) {
    const auto before = static_cast<std::uint32_t>(points_.all().size());
    std::vector<Polygon> polygons;
    division::cut_into_cells(cuts_.outline(piece), points_, polygons);
    for (Polygon& polygon : polygons) {
      for (const std::uint32_t v : polygon) {
        if (v >= before) measure(points_[v], piece);
      }
      cells.push_back({piece.face, {std::move(polygon)}});
    }
  }

  void measure(const Vec3& x, const Piece& piece) {
    const auto [a, b, c] = piece.frame;
    largest_distance_ =
        std::max(largest_distance_, division::distance_from_plane(x, points_[a], points_[b], points_[c]));
  }

  // With everything but patches and faces.
  SceneBuilder start() const {
    const SceneInside::Data& data = SceneInside::data(scene_);
    SceneBuilder builder(data.file);
    for (const std::filesystem::path& file : data.files) builder.read_from(file);
    for (const Vec3& v : points_.all()) builder.add_vertex(v);
    for (const Material& material : scene_.materials()) builder.add_material(material);
    for (std::size_t w = data.warnings_of_glass; w < data.warnings.size(); ++w) builder.warn(data.warnings[w]);
    return builder;
  }

  void add(SceneBuilder& builder, const std::string& name, const Cell& cell) {
    const Face& face = scene_.face(cell.face);
    Rings rings = cell.rings;
    const PatchId patch = builder.patch(name);
    const Selection selection{patch, static_cast<FaceId>(added_++)};
    if (face.transparent) transparent_.push_back(selection);
    if (face.flipped) {
      for (auto& ring : rings) std::ranges::reverse(ring);
      flipped_.push_back(selection);
    }
    builder.add_face(patch, face.material, std::move(rings), face.line);
  }

  const Scene& scene_;
  CutPoints points_;
  EdgeCuts cuts_;
  std::vector<Selection> transparent_, flipped_;
  std::size_t added_ = 0, faces_cut_ = 0;
  double largest_distance_ = 0.0;
};

}  // namespace

DividedScene divided(const Scene& scene, double length) {
  const kernel::StandardArithmetic arithmetic;
  require_possible(scene, length);
  return Division(scene, length).run();
}

}  // namespace exactff
