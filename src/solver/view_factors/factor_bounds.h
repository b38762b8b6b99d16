// Bounds of form factors, whatever hides the source: of their values, of how fast they change, and of both on tiles of
// a patch.
//
// Upper bounds, by distance and slope alone.
//
// F(x -> j) is at most the integral of cos cos / (pi r^2) over j. Let no point of the source be nearer to the cell than
// d, none higher above the receiver's plane than h, and no point of the cell higher above the source's plane than k.
// Then the cosines are at most h / d and k / d, and
//
//   F <= A_j / (pi d^2) * min(1, h / d) * min(1, k / d)
//
// from every point of the cell. Coordinates are at most 1 and rounded once, or those of a tile within 2^-48, so the
// distance of two boxes, a height and an area are computed to within 2^-45; each is moved by kAside to the safe side.
//
// By the angle of the planes. The part of the source in front of the receiver's plane lies in a half-plane, which x
// sees as a lune between two half great circles: the horizon, and one in the plane through x parallel to the source's.
// With the unit normals n_i and n_j, Eq. (4) is (1 - n_i . n_j) / 2 for it, which is |n_i - n_j|^2 / 4. A component of
// a unit normal errs by less than 2^-50. So two faces that are one but for a crease see next to nothing of each other.
//
// By the factor F0 of the whole source, where nothing hides it. Seen from points of the receiver's plane, the part of
// the source in front of this plane is always the same polygon, and F0 is Eq. (4) on its edges, or 0 from behind. As x
// moves, the visible directions change only where an edge sweeps over them, so F0 changes by at most 1 / pi times the
// sum, over the edges, of their angle over their distance. So with r the largest distance of the cell's corners from a
// point c, and for edges at least as far from c as d > r, of length l,
//
//   F <= F0(x) <= F0(c) + r / pi * sum of min(pi, l / (d - r)) / (d - r).
//
// It is used where d - r > 2^-10. Coordinates are rounded once, or where the receiver's plane cuts an edge, within
// 2^-44 in the direction of this edge; that turns edges as seen from c by less than 2^-33 each, and the formula's own
// roundings are less. kAsideOpen is more than all of them.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kernel/vec.h"
#include "view_factors/cell.h"
#include "view_factors/exact_scene.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/sight.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {

class FactorBound {
 public:
  // Without a source, of what is open: 1.
  explicit FactorBound(const Sight& sight);
  // Of the convex source in this plane, for points in the receiver's plane.
  FactorBound(std::span<const Vec3> source, const Plane& source_plane, const Plane& receiver);

  // At least F(x -> j) for every point x of the cell, or of the convex hull of corners in the receiver's plane; at most
  // 1.
  [[nodiscard]] double on(const Cell& cell) const { return on(positions_of(cell.corners)); }
  [[nodiscard]] double on(std::span<const Vec3> corners) const;
  // The same for all of the receiver's plane, by the angle of the planes alone.
  [[nodiscard]] double on_plane() const { return std::min(1.0, lune_); }

 private:
  static constexpr double kAnyArea = Box::kInfinity;

  Side source_plane_;
  Box source_;
  double area_ = kAnyArea, height_ = 0.0;  // of the source; above the receiver's plane
  double lune_ = 1.0;                      // by the angle of the planes
};

class OpenFactorBound {
 public:
  // Of the convex source, counter-clockwise as seen from its front, for points in the receiver's plane.
  OpenFactorBound(std::span<const Vec3> source, const Plane& receiver);

  // At least F(x -> j) for every point x of the convex hull of corners in the receiver's plane; at most 1.
  [[nodiscard]] double on(std::span<const Vec3> corners) const;

 private:
  [[nodiscard]] double factor_at(const Vec3& x) const;
  [[nodiscard]] double slope(const Vec3& x, double radius) const;

  std::vector<Vec3> source_;  // the part in front of the receiver's plane
  Vec3 normal_;               // of the receiver; of length 1
};

// The smaller of both.
class UnhiddenBound {
 public:
  UnhiddenBound(const std::vector<Vec3>& source, const Plane& source_plane, const Plane& receiver)
      : by_distance_(source, source_plane, receiver), open_(std::in_place, source, receiver) {}
  explicit UnhiddenBound(const Sight& sight);

  [[nodiscard]] double on(std::span<const Vec3> corners) const;

 private:
  FactorBound by_distance_;
  std::optional<OpenFactorBound> open_;  // if there is a source
};

// --- Slope bound ---

// How fast the factor of a source, or of what is open, can change from point to point, whatever hides it.
//
// As x moves in the receiver's plane, what it sees changes only in directions that an edge sweeps over: of the source,
// or of an occluder. An edge at a distance of d or more turns by at most |dx| / d, all along the angle w under which it
// is seen, and cos there is at most h / d for an edge that rises to h above the receiver. So on a convex region,
//
//   |F(x) - F(y)| <= |x - y| / pi * sum over pieces of edges of w / d * min(1, h / d).
//
// From within r of a point c, a piece whose ends have the distances a and b from c is seen under an angle that is at
// most r / (a - r) + r / (b - r) more than from c.
//
// Of what is open there is no source, and only edges of occluders count: cos is 0 on the horizon.
//
// Two kinds of pieces are left out.
// - One between two occluders whose rings run through it in opposite directions, if the whole region lies on the same
//   side of both. Seen from there, they lie on either side of the piece: what moves across it is hidden before and
//   after.
// - One that lies beyond a plane through c by more than r, if the source does not. A segment from x to the source that
//   begins at c instead moves by at most |x - c|, so none meets the piece. Planes through c and a side of the source
//   are tried; as far as the source lies beyond one, be it by rounding, the piece must lie farther.
// If an occluder stands on the receiver or pierces it, its edge in the receiver's plane is one of those that count, so
// F does not jump where the bound is finite. From behind the source's plane F is 0, as it is in the plane.
//
// Roundings. Coordinates are at most 1 and rounded once. Distances and heights err by less than 2^-46, and are moved by
// kAside to the safe side.

class SlopeBound {
 public:
  explicit SlopeBound(const Sight& sight);

  // At least |F(x) - F(y)| / |x - y| for all x and y of the receiver that are at most so far from the centre. Infinite
  // if it would be more than `most`.
  [[nodiscard]] double about(const Vec3& centre, double radius, double most = HUGE_VAL) const;
  // At least by how much the factor differs, on a tile, from what it is at the middle. Infinite if it would be more
  // than `most`.
  [[nodiscard]] double change_on(const Reach& tile, double most) const {
    return about(tile.middle, tile.radius, most / tile.radius) * tile.radius;
  }
  static constexpr std::size_t kMostPieces = 1 << 17;  // of edges, of all bounds together: some 20 MB
  [[nodiscard]] std::size_t pieces() const { return of_source_.size() + of_occluders_.size(); }

 private:
  static constexpr double kAside = 0x1p-40, kLeastDistance = 0x1p-28, kLongest = 0.125;
  static constexpr double kThin = 0x1p-30;                 // an angle
  static constexpr double kOverRoundings = 1.0 + 0x1p-40;  // more than the roundings of the bound itself

  // Nothing of the source is higher above the plane.
  struct Beside {
    Side plane;
    double highest;
  };
  struct Segment {
    Vec3 a, b;
    double height;
    bool is_between = false;  // two occluders, whose planes follow
    Side one, other;
  };

  [[nodiscard]] static Segment segment_of(const Sight& sight, const Edge& edge);
  [[nodiscard]] static std::vector<Segment> edges_of_occluders(const Sight& sight);
  [[nodiscard]] static std::vector<Segment> cut(const std::vector<Segment>& segments);
  [[nodiscard]] std::vector<Beside> planes_beside(const Vec3& centre) const;
  [[nodiscard]] static bool is_hidden(const Segment& segment, const Vec3& centre, double radius);
  [[nodiscard]] static double slope(const Segment& piece, const Vec3& centre, double radius);

  std::vector<Vec3> source_;                       // its corners
  std::vector<Segment> of_source_, of_occluders_;  // pieces of edges
};

// --- Patch bounds ---

// What is proved of the factor of a patch on small tiles of another one, whatever lies between.

class PatchBounds {
 public:
  // Keeps references.
  PatchBounds(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to);

  // On a tile of a part of `from`, or of a fragment of this part. Without the change if it is not asked for, or useless
  // beside the range.
  [[nodiscard]] Span on(std::size_t part, const Part& fragment, const Tile& tile, bool with_change);
  [[nodiscard]] double range_at(std::size_t part, const Vec3& point) { return range_on(of(part), {&point, 1}); }
  // The same, and the largest change for each unit of the distance from there.
  [[nodiscard]] Span about(std::size_t part, const Vec3& point);

 private:
  struct OfPart {
    bool knows_unhidden = false;
    std::vector<UnhiddenBound> unhidden;  // of each part of `to` that lies before the part, as that does before it
    std::vector<SlopeBound> slopes;       // of those that are seen
    bool slopes_asked = false, has_slopes = false;
  };

  [[nodiscard]] OfPart& of(std::size_t part);
  [[nodiscard]] OfPart& with_slopes(std::size_t part);
  [[nodiscard]] double range_on(const OfPart& of, std::span<const Vec3> corners) const;
  void add_slopes(std::size_t part, OfPart& of);
  template <class Slope>
  [[nodiscard]] static double sum_of(const OfPart& of, const Slope& slope);

  const ExactScene& scene_;
  const SeenParts& seen_;
  const PreparedPatch &from_, &to_;
  std::vector<std::optional<OfPart>> parts_;  // made when asked for
  std::size_t pieces_ = 0;                    // of all slopes
};

}  // namespace exactff::view_factors
