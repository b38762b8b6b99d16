// A scene cut into cells, each a patch.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/scene.h"
#include "scene/scene_copy.h"
#include "scene/shaft_tree.h"
#include "scene/solids.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

using kernel::Rational;
using kernel::RationalVec3;

// --- Points ---

// One part in 10^9 is allowed, so that roundings of a length add no cell.
constexpr double kTolerance = 1e-9;

bool comes_before(const Vec3& a, const Vec3& b) { return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z); }

// Scaled so that the square is about 1. Positive unless the square is 0.
double root_of(const Rational& square) {
  if (kernel::sign(square) == 0) return 0.0;
  const long exponent = (kernel::bit_length(square.get_num()) - kernel::bit_length(square.get_den())) / 2;
  const double root = std::sqrt(kernel::nearest_double(kernel::times_power_of_two(square, -2 * exponent)));
  return std::max(std::ldexp(root, static_cast<int>(exponent)), std::numeric_limits<double>::denorm_min());
}

RationalVec3 point_of_segment(const Vec3& p, const Vec3& q, std::size_t k, std::size_t n) {
  const RationalVec3 from = kernel::to_rational(p);
  Rational share(static_cast<unsigned long>(k), static_cast<unsigned long>(n));
  share.canonicalize();
  return from + (kernel::to_rational(q) - from) * share;
}

Vec3 nearest(const RationalVec3& a) {
  return {kernel::nearest_double(a.x), kernel::nearest_double(a.y), kernel::nearest_double(a.z)};
}

// The vector between two points, over a length: neither overflows, nor underflows where the quotient is not tiny.
Vec3 difference_over(const Vec3& to, const Vec3& from, double length) {
  const auto quotient = [length](double a, double b) {
    const double difference = a - b;
    return std::isfinite(difference) ? difference / length : (0.5 * a - 0.5 * b) / (0.5 * length);
  };
  return {quotient(to.x, from.x), quotient(to.y, from.y), quotient(to.z, from.z)};
}

// The vertices of a scene, and those that cells add.
class CutPoints {
 public:
  CutPoints(std::span<const Vec3> vertices, double length)
      : vertices_(vertices.begin(), vertices.end()), length_(length) {}

  [[nodiscard]] const Vec3& operator[](std::uint32_t vertex) const { return vertices_[vertex]; }
  [[nodiscard]] std::span<const Vec3> all() const { return vertices_; }
  [[nodiscard]] double length() const { return length_; }

  // The fewest equal parts of a segment that are not longer than LENGTH.
  [[nodiscard]] std::size_t parts(std::uint32_t a, std::uint32_t b) const {
    const double ratio = kernel::distance(difference_over(vertices_[b], vertices_[a], length_), {});
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(ratio * (1.0 - kTolerance))));
  }

  // New vertices between the two, in the order from a to b, that cut the segment into these parts. They are the same
  // in the other direction: of n parts, the k-th ends at p + (q - p) k / n, rounded once, where p is the end that comes
  // first by x, then y, then z.
  std::vector<std::uint32_t> between(std::uint32_t a, std::uint32_t b) {
    const bool turned = comes_before(vertices_[b], vertices_[a]);
    const Vec3 p = vertices_[turned ? b : a], q = vertices_[turned ? a : b];
    const std::size_t n = parts(a, b);
    std::vector<std::uint32_t> made;
    for (std::size_t k = 1; k < n; ++k) {
      const RationalVec3 exact = point_of_segment(p, q, k, n);
      const Vec3 rounded = nearest(exact);
      const RationalVec3 off = kernel::to_rational(rounded) - exact;
      largest_displacement_ = std::max(largest_displacement_, root_of(dot(off, off)));
      made.push_back(static_cast<std::uint32_t>(vertices_.size()));
      vertices_.push_back(rounded);
      origins_.push_back({turned ? b : a, turned ? a : b, static_cast<double>(k) / static_cast<double>(n)});
    }
    if (turned) std::ranges::reverse(made);
    return made;
  }

  // Of a new vertex: it lies between these, at this share of the way.
  struct Origin {
    std::uint32_t from = 0, to = 0;
    double share = 0.0;
  };
  [[nodiscard]] const Origin* origin(std::uint32_t vertex) const {
    const std::size_t before = vertices_.size() - origins_.size();
    return vertex < before ? nullptr : &origins_[vertex - before];
  }

  // The largest distance of a point made by between() from its exact place.
  [[nodiscard]] double largest_displacement() const { return largest_displacement_; }

 private:
  std::vector<Vec3> vertices_;
  std::vector<Origin> origins_;  // of the last vertices
  double length_;
  double largest_displacement_ = 0.0;
};

// The distance of a point from the plane through three others, computed exactly and rounded: 0 only if it is in it.
// Smaller than all doubles, it is the smallest positive one.
double distance_from_plane(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const RationalVec3 origin = kernel::to_rational(a);
  const RationalVec3 normal = cross(kernel::to_rational(b) - origin, kernel::to_rational(c) - origin);
  const Rational height = dot(normal, kernel::to_rational(x) - origin);
  return root_of(height * height / dot(normal, normal));
}

// Whether all corners of a polygon lie exactly in one plane.
bool is_planar(const CutPoints& points, std::span<const std::uint32_t> polygon) {
  const Vec3& a = points[polygon[0]];
  std::size_t c = 2;
  const auto straight = [&](std::size_t third) {
    return is_zero(cross(kernel::exact_difference(points[polygon[1]], a).v,
                         kernel::exact_difference(points[polygon[third]], a).v));
  };
  while (c < polygon.size() && straight(c)) ++c;
  for (std::size_t d = c + 1; d < polygon.size(); ++d) {
    if (kernel::orientation(a, points[polygon[1]], points[polygon[c]], points[polygon[d]]) != 0) return false;
  }
  return true;
}

// --- Edges ---

// The edges of a scene's pieces, cut so that all faces along an edge share its points.
//
// 1. An edge that is longer than LENGTH is parted at the corners of other faces that lie on it (T-junctions), exactly.
// 2. Each part is cut into the fewest equal lengths, by the rule of CutPoints::between(), which depends on its ends
//    alone. So faces that have the edge in different parts agree on all points.
// An edge is identified by the positions of its ends, as in closed_surfaces.h.

class EdgeCuts {
 public:
  // Adds the points of all edges to `points`, whose first vertices are those of the scene.
  EdgeCuts(const Scene& scene, CutPoints& points) : scene_(scene), points_(points) {
    const std::span<const std::uint32_t> place = places(scene);
    std::vector<Ends> edges;
    for (const Piece& piece : scene.pieces()) {
      const std::span<const std::uint32_t> corners = scene.corners(piece);
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const std::uint32_t a = place[corners[c]], b = place[corners[(c + 1) % corners.size()]];
        corners_[0].push_back(a);
        edges.push_back(std::minmax(a, b));
      }
    }
    corners_[1] = corners_[2] = corners_[0];
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<std::uint32_t>& sorted = corners_[axis];
      std::ranges::sort(sorted, {}, [&](std::uint32_t v) { return std::pair(kernel::coordinate(points[v], axis), v); });
      sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const Ends& ends : edges) of_edges_.emplace(ends, cut(ends));
  }

  // A piece with the points of its edges among its corners. All are places.
  [[nodiscard]] std::vector<std::uint32_t> outline(const Piece& piece) const {
    const std::span<const std::uint32_t> place = places(scene_), corners = scene_.corners(piece);
    std::vector<std::uint32_t> all;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const std::uint32_t a = place[corners[c]], b = place[corners[(c + 1) % corners.size()]];
      all.push_back(a);
      const std::vector<std::uint32_t>& points = of_edges_.at(std::minmax(a, b));
      if (a < b) {
        all.insert(all.end(), points.begin(), points.end());
      } else {
        all.insert(all.end(), points.rbegin(), points.rend());
      }
    }
    return all;
  }

 private:
  using Ends = std::pair<std::uint32_t, std::uint32_t>;  // the lower place first

  // In the order from the first end. Of the corners within the range of one coordinate, the axis with the fewest.
  [[nodiscard]] std::vector<std::uint32_t> junctions(const Ends& ends) const {
    const Vec3 a = points_[ends.first], b = points_[ends.second];
    std::span<const std::uint32_t> fewest = corners_[0];
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](std::uint32_t v) { return kernel::coordinate(points_[v], axis); };
      const auto [low, high] = std::minmax({kernel::coordinate(a, axis), kernel::coordinate(b, axis)});
      const auto first = std::ranges::lower_bound(corners_[axis], low, {}, at);
      const auto last = std::ranges::upper_bound(corners_[axis], high, {}, at);
      if (static_cast<std::size_t>(last - first) < fewest.size()) fewest = {first, last};
    }
    const auto within = [](double u, double from, double to) {
      return std::min(from, to) <= u && u <= std::max(from, to);
    };
    std::vector<std::uint32_t> found;
    for (const std::uint32_t v : fewest) {
      const Vec3 x = points_[v];
      if (v == ends.first || v == ends.second || !within(x.x, a.x, b.x) || !within(x.y, a.y, b.y) ||
          !within(x.z, a.z, b.z)) {
        continue;
      }
      if (are_straight(a, x, b)) found.push_back(v);
    }
    const auto from_a = [&](std::uint32_t v) {
      const Vec3 x = points_[v];
      return std::tuple(a.x < b.x ? x.x : -x.x, a.y < b.y ? x.y : -x.y, a.z < b.z ? x.z : -x.z);
    };
    std::ranges::sort(found, {}, from_a);
    return found;
  }

  [[nodiscard]] std::vector<std::uint32_t> cut(const Ends& ends) {
    if (points_.parts(ends.first, ends.second) == 1) return {};
    std::vector<std::uint32_t> stops = junctions(ends), all;
    stops.push_back(ends.second);
    std::uint32_t from = ends.first;
    for (const std::uint32_t to : stops) {
      const std::span<const std::uint32_t> points = part(from, to);
      if (from < to) {
        all.insert(all.end(), points.begin(), points.end());
      } else {
        all.insert(all.end(), points.rbegin(), points.rend());
      }
      if (to != ends.second) all.push_back(to);
      from = to;
    }
    return all;
  }

  [[nodiscard]] std::span<const std::uint32_t> part(std::uint32_t from, std::uint32_t to) {
    const Ends ends = std::minmax(from, to);
    const auto [place, is_new] = of_parts_.try_emplace(ends);
    if (is_new) place->second = points_.between(ends.first, ends.second);
    return place->second;
  }

  const Scene& scene_;
  CutPoints& points_;
  std::vector<std::uint32_t> corners_[3];                // places of all pieces' corners, by each coordinate
  std::map<Ends, std::vector<std::uint32_t>> of_parts_;  // the points of edges without junctions, from the lower place
  std::map<Ends, std::vector<std::uint32_t>> of_edges_;  // the points of all edges, with junctions
};

// --- Cells ---

// Cuts a convex polygon, whose outline is cut already, into cells.
//
// 1. A polygon is a cell if it has at most four corners, none of them straight, or if no two corners are farther apart
//    than LENGTH. A cell is exactly planar; one that is not is cut into triangles.
// 2. Otherwise it is cut along a chord between two points of its outline: the shortest that leaves at least a quarter
//    of the area on either side; of several, the one whose parts are the most alike. A chord longer than LENGTH is cut
//    into equal lengths, whose points both sides share. So no cell has a point of another one of the polygon inside
//    an edge, and a rectangle becomes a grid.
// 3. Both parts are cut likewise.
//
// It ends: a chord that is not cut leaves fewer points on either side. One is cut only where the area exceeds a
// fraction of LENGTH^2, and the areas of the parts fall in proportion.
//
// Lengths and areas are estimates; only planarity is decided exactly.

using Polygon = std::vector<std::uint32_t>;  // vertices, counter-clockwise seen from its front

// Whether two points of these are farther apart than LENGTH.
bool is_wide(std::span<const std::uint32_t> vertices, const CutPoints& points) {
  for (std::size_t a = 0; a < vertices.size(); ++a) {
    for (std::size_t b = a + 1; b < vertices.size(); ++b) {
      if (points.parts(vertices[a], vertices[b]) > 1) return true;
    }
  }
  return false;
}

constexpr double kStraight = 1e-6;  // the share of the area that a corner cuts off

struct Chord {
  std::size_t from = 0, to = 0;  // corners, from < to
  double squared_length = 0.0;
  double smaller_area = 0.0;
};

// A polygon around the origin, in a frame where its coordinates are at most 2.
class FlatPolygon {
 public:
  FlatPolygon(const Polygon& polygon, const CutPoints& points) {
    const Vec3& origin = points[polygon.front()];
    for (const std::uint32_t v : polygon) {
      extent_ = std::max(extent_, kernel::max_norm(kernel::difference(points[v], origin)));
    }
    extent_ = std::min(extent_, std::numeric_limits<double>::max());
    for (const std::uint32_t v : polygon) at_.push_back(difference_over(points[v], origin, extent_));
    Vec3 twice_area;
    for (std::size_t k = 0; k < size(); ++k) {
      twice_area = kernel::sum(twice_area, kernel::cross(at_[k], at_[(k + 1) % size()]));
    }
    normal_ = kernel::unit(twice_area);
    swept_.push_back(0.0);
    for (std::size_t k = 0; k + 1 < size(); ++k) swept_.push_back(swept_.back() + sweep(k, k + 1));
  }

  [[nodiscard]] std::size_t size() const { return at_.size(); }
  [[nodiscard]] double extent() const { return extent_; }  // the length of 1
  [[nodiscard]] double area() const { return part(0, size() - 1); }
  // Of the part from one corner to a later one.
  [[nodiscard]] double part(std::size_t from, std::size_t to) const {
    return swept_[to] - swept_[from] + sweep(to, from);
  }
  [[nodiscard]] Chord chord(std::size_t from, std::size_t to) const {
    const Vec3 d = kernel::difference(at_[to], at_[from]);
    const double beyond = part(from, to);
    return {from, to, kernel::dot(d, d), std::min(beyond, area() - beyond)};
  }
  [[nodiscard]] bool has_straight_corner() const {
    for (std::size_t k = 0; k < size(); ++k) {
      const Vec3& x = at_[k];
      const Vec3 a = kernel::difference(at_[(k + 1) % size()], x);
      const Vec3 b = kernel::difference(at_[(k + size() - 1) % size()], x);
      if (0.5 * kernel::dot(normal_, kernel::cross(a, b)) <= kStraight * area()) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] double sweep(std::size_t a, std::size_t b) const {
    return 0.5 * kernel::dot(normal_, kernel::cross(at_[a], at_[b]));
  }

  std::vector<Vec3> at_;
  double extent_ = 0.0;
  Vec3 normal_;
  std::vector<double> swept_;
};

template <class Visit>
void for_each_chord(const FlatPolygon& polygon, const Visit& visit) {
  const std::size_t n = polygon.size();
  for (std::size_t from = 0; from + 2 < n; ++from) {
    for (std::size_t to = from + 2; to < n; ++to) {
      if (from != 0 || to + 1 != n) visit(polygon.chord(from, to));
    }
  }
}

// Step 2. Where no chord leaves a quarter, the one that leaves the most.
Chord best_chord(const FlatPolygon& polygon) {
  constexpr double kLeast = 0.25 * (1.0 - kTolerance);
  const double least = kLeast * polygon.area();
  std::optional<double> shortest;
  for_each_chord(polygon, [&](const Chord& chord) {
    if (chord.smaller_area >= least && (!shortest || chord.squared_length < *shortest)) {
      shortest = chord.squared_length;
    }
  });
  std::optional<Chord> best;
  for_each_chord(polygon, [&](const Chord& chord) {
    if (shortest && (chord.smaller_area < least || chord.squared_length > *shortest * (1.0 + kTolerance))) return;
    if (!best || chord.smaller_area > best->smaller_area * (1.0 + kTolerance)) best = chord;
  });
  return *best;
}

class Cutter {
 public:
  Cutter(CutPoints& points, std::vector<Polygon>& cells) : points_(points), cells_(cells) {}

  void cut(const Polygon& polygon) {
    if (polygon.size() == 3) return cells_.push_back(polygon);
    const FlatPolygon flat(polygon, points_);
    const bool fits = is_cell(polygon, flat);
    if (fits && is_planar(points_, polygon)) return cells_.push_back(polygon);
    const Chord chord = best_chord(flat);
    const std::uint32_t a = polygon[chord.from], b = polygon[chord.to];
    const std::vector<std::uint32_t> between =
        fits || is_small(flat) ? std::vector<std::uint32_t>() : points_.between(a, b);
    Polygon left(polygon.begin() + static_cast<std::ptrdiff_t>(chord.to), polygon.end());
    left.insert(left.end(), polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(chord.from) + 1);
    left.insert(left.end(), between.begin(), between.end());
    Polygon right(polygon.begin() + static_cast<std::ptrdiff_t>(chord.from),
                  polygon.begin() + static_cast<std::ptrdiff_t>(chord.to) + 1);
    right.insert(right.end(), between.rbegin(), between.rend());
    cut(left);
    cut(right);
  }

 private:
  [[nodiscard]] bool is_cell(const Polygon& polygon, const FlatPolygon& flat) const {
    return (polygon.size() == 4 && !flat.has_straight_corner()) || !is_wide(polygon, points_);
  }
  // Its chords are not cut, so that cutting ends.
  [[nodiscard]] bool is_small(const FlatPolygon& flat) const {
    constexpr double kLeastShare = 1.0 / 64.0;
    const double length = points_.length() / flat.extent();
    return !(flat.area() > kLeastShare * length * length);
  }

  CutPoints& points_;
  std::vector<Polygon>& cells_;
};

// Requires at least three points, about in one plane and convex. Adds the cells in an order that depends on the
// polygon alone.
void cut_into_cells(const Polygon& polygon, CutPoints& points, std::vector<Polygon>& cells) {
  Cutter(points, cells).cut(polygon);
}

// --- The scene ---

using Rings = std::vector<std::vector<std::uint32_t>>;

// An estimate of the number of a piece's cells and of their points along edges.
double expected_cells(const Scene& scene, const Piece& piece, double length) {
  const std::span<const std::uint32_t> corners = scene.corners(piece);
  const auto at = [&](std::size_t c) {
    const Vec3& origin = scene.vertices()[corners.front()];
    return difference_over(scene.vertices()[corners[c % corners.size()]], origin, length);
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
    for (auto parts = text::part_name(name); parts; parts = text::part_name(parts->patch)) {
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
    return {with_faces(builder.build(), flipped_, transparent_), faces_cut_, added_, deviation};
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
    if (face.shape == FaceShape::kPlanar && !is_wide(face.rings.front(), points_)) {
      cells.push_back({id, face.rings});
      return;
    }
    for (const Piece& piece : scene_.pieces_of(id)) add_cells_of(piece, cells);
    if (cells.size() > before + 1) ++faces_cut_;
  }

  void add_cells_of(const Piece& piece, std::vector<Cell>& cells) {
    const auto before = static_cast<std::uint32_t>(points_.all().size());
    std::vector<Polygon> polygons;
    cut_into_cells(cuts_.outline(piece), points_, polygons);
    for (Polygon& polygon : polygons) {
      for (const std::uint32_t v : polygon) {
        if (v >= before) measure(points_[v], piece);
      }
      cells.push_back({piece.face, {std::move(polygon)}});
    }
  }

  void measure(const Vec3& x, const Piece& piece) {
    const auto [a, b, c] = piece.frame;
    largest_distance_ = std::max(largest_distance_, distance_from_plane(x, points_[a], points_[b], points_[c]));
  }

  // With everything but patches and faces.
  SceneBuilder start() const {
    const SceneInside::Data& data = SceneInside::data(scene_);
    SceneBuilder builder = begun_as(scene_);
    for (const Vec3& v : points_.all()) builder.add_vertex(v);
    for (std::size_t w = data.warnings_of_glass; w < data.warnings.size(); ++w) builder.warn(data.warnings[w]);
    return builder;
  }

  // Of a corner of a cell of this face. A vertex that neither was made nor is a corner of the face is one of another
  // face, on an edge of the face's pieces.
  TexturePoint texture_point(const FaceTexture& texture, FaceId face, std::uint32_t v) {
    std::map<std::uint32_t, TexturePoint>& known = known_[texture_set(texture.set())];
    const CutPoints::Origin* origin = points_.origin(v);
    if (origin == nullptr) v = places(scene_)[v];
    if (const TexturePoint* corner = texture.find(v)) return *corner;
    if (const auto found = known.find(v); found != known.end()) return found->second;
    const CutPoints::Origin made = origin != nullptr ? *origin : place_on_edge(face, v);
    const TexturePoint from = texture_point(texture, face, made.from);
    return known[v] = between(from, texture_point(texture, face, made.to), made.share);
  }

  [[nodiscard]] CutPoints::Origin place_on_edge(FaceId face, std::uint32_t v) const {
    for (const Piece& piece : scene_.pieces_of(face)) {
      const std::span<const std::uint32_t> corners = scene_.corners(piece);
      for (std::size_t c = 0; c < corners.size(); ++c) {
        std::uint32_t a = corners[c], b = corners[(c + 1) % corners.size()];
        if (comes_before(points_[b], points_[a])) std::swap(a, b);
        if (comes_before(points_[v], points_[a]) || comes_before(points_[b], points_[v])) continue;
        if (!are_straight(points_[a], points_[v], points_[b])) continue;
        const double whole = kernel::distance(points_[a], points_[b]);
        return {a, b, kernel::distance(points_[a], points_[v]) / whole};
      }
    }
    return {scene_.corners(scene_.pieces_of(face).front())[0], scene_.corners(scene_.pieces_of(face).front())[0], 0.0};
  }

  void add(SceneBuilder& builder, const std::string& name, const Cell& cell) {
    const Face& face = scene_.face(cell.face);
    Rings rings = cell.rings;
    const PatchId patch = builder.patch(name);
    const auto id = static_cast<FaceId>(added_++);
    if (face.transparent) transparent_.push_back(id);
    if (face.flipped) {
      for (auto& ring : rings) std::ranges::reverse(ring);
      flipped_.push_back(id);
    }
    builder.add_face(patch, face.material, rings, face.line);
    if (std::exchange(textured_, cell.face) != cell.face) known_ = {};
    copy_texture(scene_, cell.face, rings, builder,
                 [&](const FaceTexture& texture, std::uint32_t v) { return texture_point(texture, cell.face, v); });
  }

  const Scene& scene_;
  CutPoints points_;
  EdgeCuts cuts_;
  std::vector<FaceId> transparent_, flipped_;
  std::optional<FaceId> textured_;  // the face of the texture coordinates below
  std::array<std::map<std::uint32_t, TexturePoint>, kTextureSets> known_;
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
