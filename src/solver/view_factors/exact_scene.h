// Points, planes and convex polygons in exact coordinates, and a scene's pieces in them, prepared once for all pairs.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactff/scene.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/closed_surfaces.h"
#include "scene/panels.h"

namespace exactff::view_factors {

// --- Exact space ---

// Points and planes in exact homogeneous coordinates, for the cells of a receiver (cell.h).
//
// A point (x, y, z, w), w > 0, is the point (x, y, z) / w in integer units; a plane (a, b, c, d) holds the points with
// a x + b y + c z + d w = 0. Joining three points and cutting three planes are the same 3 x 3 minors.
//
// Each also has doubles for filters and for integration, in units of 2^shift integer units: then no coordinate of the
// scene exceeds 1. Every one of them has a relative error of at most u = 2^-53, up to one positive factor for a plane;
// an underflow adds at most 2^-1074. Four products carry at most 3u each and their sums at most 3u: the
// total is below 8u of the sum of the magnitudes, as certified_sign requires.

using kernel::Integer;
using Homogeneous = std::array<Integer, 4>;

// How the doubles of a scene become integers: coordinate * 2^-exponent; and the integers the doubles of filters.
struct Units {
  long exponent = 0;
  long shift = 0;

  [[nodiscard]] static Units of(std::span<const Vec3> vertices);
};

// Numbers of so many bits, or kManyBits. Doubles of few bits are exact, and so is what is computed from them.
inline constexpr int kManyBits = 1000;

struct Point {
  Homogeneous exact;
  Vec3 at;               // in units of 2^shift
  int bits = kManyBits;  // of x, y and z, if w is 1
};

struct Plane {
  Homogeneous exact;
  std::array<double, 4> rounded{};
  int bits = kManyBits;  // of all four
};

[[nodiscard]] Point point_of(const Vec3& vertex, const Units& units);
[[nodiscard]] Point make_point(Homogeneous exact, const Units& units);  // any w other than zero
[[nodiscard]] Plane make_plane(Homogeneous exact, const Units& units);

// A half-space, in doubles, where the height is positive. It errs by less than 2^-46 where no coordinate exceeds 1.
struct Side {
  Vec3 normal;  // of length 1
  double offset = 0.0;

  [[nodiscard]] static Side of(const Plane& plane);
  [[nodiscard]] double height(const Vec3& x) const { return kernel::dot(normal, x) + offset; }
  [[nodiscard]] Side opposite() const { return {kernel::scaled(normal, -1.0), -offset}; }
};

// The plane through three points; positive on the side from which they run counter-clockwise. All zero if they lie on
// one line.
[[nodiscard]] Homogeneous join(const Point& a, const Point& b, const Point& c);
// The point that three planes share; all zero if there is none, or more than one.
[[nodiscard]] Homogeneous meet(const Plane& a, const Plane& b, const Plane& c);
[[nodiscard]] bool is_zero(const Homogeneous& a);
[[nodiscard]] Homogeneous opposite(Homogeneous a);

// -1, 0, +1: the side of the plane on which the point lies.
[[nodiscard]] int side_of(const Plane& plane, const Point& point);

// A filter for the side of the plane through three points, before the plane is made exactly.
//
// With u = 2^-53: coordinates are at most 1 and rounded once, so each component of a difference of two points errs by
// at most e = 4u. Let A, B, C bound the components of the three differences and their true values: their largest
// magnitudes, plus e. Each of the six products of det(b - a, c - a, x - a) errs by at most e S, S = AB + BC + CA.
// Rounding the products and their sum adds at most 6u to each, 36u ABC <= 25u S, since A, B, C are below 2 + 2e. The
// total is at most 49u S, and the filter decides beyond 2^-46 S = 128u S. An underflow is negligible beside S >= 3 e^2.
//
// With coordinates of at most 15 bits nothing is rounded: the differences have 16 bits, the normal 33, each of the
// three last products 49, and their sum 51.
class RoundedPlane {
 public:
  RoundedPlane(const Point& a, const Point& b, const Point& c);

  // Up to rounding, a positive multiple of the distance.
  [[nodiscard]] double height(const Vec3& x) const;
  // kernel::kUncertain: the filter declines.
  [[nodiscard]] int side_of(const Point& x) const;
  // The point's height is certainly larger, on either side, than so many times its error.
  [[nodiscard]] bool is_beyond(const Vec3& x, double errors) const;

 private:
  [[nodiscard]] double error_at(const Vec3& from_origin) const;

  Vec3 origin_, normal_;
  double product_ = 0.0, sum_ = 0.0;  // AB and A + B
  bool is_exact_ = false;             // the normal
};

// --- Exact scene ---

// A box of points, in the units of Point::at. Each of its numbers is rounded once.
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};

  void include(const Vec3& v);
  // Certainly: apart by more than the roundings.
  [[nodiscard]] bool is_apart_from(const Box& other) const;
};

[[nodiscard]] Box box_of(std::span<const Point> points);
// The distance of the two, but for roundings.
[[nodiscard]] double gap(const Box& a, const Box& b);

inline constexpr std::uint32_t kNoSurface = std::numeric_limits<std::uint32_t>::max();

// A convex piece, or a panel of several (scene/panels.h), without corners in the middle of a straight side.
struct ExactPiece {
  FaceId face{};  // of a joined panel one of several
  bool transparent = false;
  std::uint32_t surface = kNoSurface;  // an index of ExactScene::surfaces
  std::vector<std::uint32_t> corners;  // vertex indices, counter-clockwise from the front; one index for each position
  Plane plane;                         // positive in front
  Box box;
};

// A closed surface of the scene (scene/closed_surfaces.h).
struct ExactSurface {
  Box box;
  bool turned_inside_out = false;
  std::optional<Plane> rim;           // of one with holes: the surface lies on its positive side
  std::vector<std::uint32_t> pieces;  // ascending
};

struct ExactScene {
  explicit ExactScene(const Scene& scene);

  // Of a piece or a joined panel.
  [[nodiscard]] const ExactPiece& panel(PanelId id) const {
    return id < pieces.size() ? pieces[id] : joined[id - pieces.size()];
  }

  const Scene& scene;
  Units units;
  std::vector<Point> vertices;     // by vertex index; those of other vertices at a known position are left empty
  std::vector<ExactPiece> pieces;  // as Scene::pieces()
  std::vector<ExactPiece> joined;  // the panels of several pieces
  std::vector<ExactSurface> surfaces;

 private:
  [[nodiscard]] ExactPiece exact_piece(const Piece& piece, std::span<const std::uint32_t> corners);
};

// By their indices.
[[nodiscard]] std::vector<ExactSurface> exact_surfaces(const ClosedSurfaces& closed, std::span<const ExactPiece> pieces,
                                                       const Units& units);

// --- Polygons ---

// Convex polygons that share a table of points and lines.
//
// The line of an edge is the one through the two points that first defined it, even if clipping has shortened the edge:
// their coordinates are short. Edges along one another, as neighbouring faces have them, share their line.

using PointId = std::uint32_t;
using LineId = std::uint32_t;

struct Line {
  PointId a, b;
};

struct Edge {
  PointId from, to;
  LineId line;
  bool along;  // from `a` to `b` of the line
};

// Counter-clockwise as seen from its front; no two consecutive edges lie on one line.
using Ring = std::vector<Edge>;

[[nodiscard]] inline Ring reverse_of(const Ring& ring) {
  Ring result;
  for (auto edge = ring.rbegin(); edge != ring.rend(); ++edge) {
    result.push_back({edge->to, edge->from, edge->line, !edge->along});
  }
  return result;
}

class Points {
 public:
  explicit Points(const Units& units) : units_(units) {}
  Points(Points&&) = default;
  Points& operator=(Points&&) = default;

  [[nodiscard]] const Units& units() const { return units_; }
  [[nodiscard]] std::size_t point_count() const { return points_.size(); }
  [[nodiscard]] std::size_t line_count() const { return lines_.size(); }
  [[nodiscard]] const Point& operator[](PointId id) const { return *points_[id]; }
  [[nodiscard]] const Line& line(LineId id) const { return lines_[id]; }

  PointId add(Point point);
  PointId refer_to(const Point& point);  // which must stay where it is
  // The polygon with these corners, none of which lies in the middle of a straight side.
  Ring ring(const std::vector<PointId>& corners);
  // The part of the polygon on the positive side of the plane; empty if it has no area. `name` tells planes apart:
  // where one cuts a line that it has cut before, the point is the same.
  Ring clip(const Ring& ring, const Plane& plane, std::uint32_t name);
  // From where the line of the one edge crosses the plane to where that of the other does.
  Edge between_crossings(const Edge& one, const Edge& other, const Plane& plane, std::uint32_t name);
  [[nodiscard]] std::vector<Vec3> positions(const Ring& ring) const;  // rounded
  // Frees what only further rings need.
  void complete();

 private:
  Edge edge(PointId from, PointId to);
  PointId crossing(const Edge& edge, const Plane& plane, std::uint32_t name);

  Units units_;
  std::deque<Point> own_;  // keeps its elements in place
  std::vector<const Point*> points_;
  std::vector<Line> lines_;
  std::map<std::pair<PointId, PointId>, LineId> line_of_;
  std::map<std::pair<LineId, std::uint32_t>, PointId> crossing_of_;
};

}  // namespace exactff::view_factors
