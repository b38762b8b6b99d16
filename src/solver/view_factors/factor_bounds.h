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

// --- Hidden bound ---

// How much an occluder hides at most of the source from a cell: the integral over the cell. A wall of a room that is
// closed but for roundings hides slivers of other walls, from slivers of them; with these bounds, they make no cells.
//
// By what lies behind it. Let h be affine, and h <= 0 on the occluder. Where h > 0 at both ends of a segment, it is so
// between them, and the segment misses the occluder. So with C' and S' the parts of the cell and of the source where
// h <= 0, the integral is at most
//
//   integral over C' of F(x -> S) + integral over C of F(x -> S'),
//
// and the second one, which is also that over S' of F(y -> C), is at most the area of S'. Any direction can be that of
// h: those of all planes of the pair are tried.
//
// By its height. Let no point of the occluder be higher above the receiver's plane than h, and let P be its projection
// to this plane, which is convex. From x at the distance t > 0 of P, a line in the plane has all of P on its other side
// and is at the distance t, so the occluder is seen below an elevation a, tan a <= h / t, in a lune between the horizon
// and a plane through x along the line. So it hides at most (1 - cos a) / 2 <= a^2 / 4 <= h^2 / (4 t^2). In a convex
// cell, the places at the distance t of P are part of the boundary of a convex set in the cell, and no longer than the
// cell's perimeter. So with the area of what P covers of the cell, the integral is at most
//
//   area + perimeter * integral over t > 0 of min(1, h^2 / (4 t^2)) = area + perimeter * h.
//
// Likewise for the source: as A_i F_ij = A_j F_ji, what is hidden from the cell of the source is what is hidden from
// the source of the cell.
//
// Roundings. A height errs by less than 2^-46. The parts are those where it is at most kAside as computed: a place
// between the ends of a side where linear interpolation says kAside is above 0 in truth. Areas get a margin of kAside,
// as a side is at most 2 long.

// An occluder that is low above a plane.
class LowOccluder {
 public:
  LowOccluder(const Side& above, std::span<const Vec3> occluder);

  [[nodiscard]] double height() const { return height_; }
  // At least the integral over the convex polygon in the plane of what is hidden; `size`: at least its area.
  [[nodiscard]] double hidden_from(std::span<const Vec3> polygon, double size) const;

 private:
  double height_ = 0.0;
  Box box_;
  std::vector<Side> around_;  // positive outside of its projection
};

class HiddenBound {
 public:
  // There must be a source, in this plane. `directions`: of length 1, each tried both ways.
  HiddenBound(const Sight& sight, const Plane& source_plane, std::span<const Vec3> directions,
              const Occluder& occluder);

  [[nodiscard]] bool may_be_small() const { return may_be_small_; }
  // `most`: at least F of the whole source from any point of the cell; `size`: at least its area.
  [[nodiscard]] double on(std::span<const Vec3> cell, double most, double size) const;

 private:
  static constexpr double kSmall = 0x1p-5;  // of the source's area
  static constexpr double kMost = 0.875;    // of the receiver's, of which cells are parts
  static constexpr double kLow = 0x1p-8;

  struct Behind {
    Side plane;
    double area;       // of the part of the source
    FactorBound part;  // of its factor
  };
  std::vector<Behind> behind_;
  std::optional<LowOccluder> above_receiver_;
  double from_source_ = HUGE_VAL;  // if it is low above its plane
  bool may_be_small_ = false;
};

// What one occluder hides, and another one does not, as where two walls meet at a corner of a room, but for roundings.
//
// Let h = 0 be the plane of the outer occluder. A segment that meets the inner one begins where h <= 0, or ends at a
// point of the inner one where h >= 0, or crosses the plane in between, in the hull of the cell and the inner occluder.
// If the outer one does not block it, it crosses outside of it. Of all these segments, those that pass a set of places
// in a plane carry at most the area of the set, by A_i F_ij = A_j F_ji; and where the set is at least d away, at most
// the cell's area times that of the set over pi d^2. So with K the outer occluder, and K' the
// polygon that its sides become when each is moved outwards as far as the hull reaches, the integral is at most
//
//   integral of F over the cell where h <= 0  +  twice the area of the inner one where h >= 0  +  area of K' - area of
//   K.
//
// The outer one may be two triangles that share a side, as those of a bent face. With d the distance of the second one
// from the plane h = 0 of the first, a segment that crosses the plane in the projection of the second, and misses this,
// passes between the sides of both, or begins or ends in between. So h <= d and h >= -d count instead, and twice the
// perimeter times d more. Of the polygon of both, convex or not, the half-planes of the sides share the kernel: K.
// Corners that are almost one are made one, as the direction of a side between them means nothing: this moves a side by
// their distance at one end, over half of its length on average.

class CoverBound {
 public:
  // `neighbour`: shares this side of the outer occluder.
  struct Neighbour {
    std::uint32_t occluder;
    std::size_t side;
  };
  CoverBound(const Sight& sight, std::uint32_t inner, std::uint32_t outer, std::optional<Neighbour> neighbour);

  [[nodiscard]] bool may_be_small() const { return may_be_small_; }
  // At least the integral of what the inner one hides from the cell, and the outer does not; infinite if it is no
  // sliver. `most`: as above.
  [[nodiscard]] double on(std::span<const Vec3> cell, double most, double size) const;

 private:
  static constexpr double kSmall = 0x1p-8, kOneCorner = 0x1p-12;

  // Places in a plane, of which each point may count from either side as often as the area says.
  struct Sliver {
    double area = 0.0;
    Box box;
  };
  static void add(std::span<const Vec3> part, double times, std::vector<Sliver>& slivers);
  // Without corners that are almost those before.
  void take_outline(std::vector<Vec3> outline);
  // Of the places in the plane that are no farther outwards than this.
  [[nodiscard]] std::vector<Vec3> within(std::span<const double> reach) const;

  Side plane_;
  std::vector<Vec3> outwards_;  // of each side
  std::vector<double> sides_;   // and its height
  std::vector<Vec3> inner_;
  double behind_ = 0.0;          // the most height that counts as behind the plane
  std::vector<Sliver> slivers_;  // the same for all cells
  bool may_be_small_ = false;
};

// --- Strip to the horizon ---

// A source or an occluder of which sides are almost in the receiver's plane (NearHorizon) is almost a larger one that
// ends in this plane, up to which F is analytic. The difference is at most F of the strip between the two. Its integral
// over a cell is at most the area of the strip, as what is hidden at the source is (above); twice that if the cell may
// lie on both sides of the strip.
//
// Near the strip less is known to be enough. Let no point of the strip be higher above the receiver's plane than h, nor
// farther on the cell's side of the line on which the two planes meet than w, both measured across this line. From the
// distance d > w of the line, the strip is seen below the elevation a, tan a <= h / (d - w), in a lune between the
// horizon and a plane through x along the line: F <= (1 - cos a) / 2 <= a^2 / 4 <= h^2 / (4 (d - w)^2). It is also at
// most m, by the angle of the planes. So over a cell of the length l along the line, the integral is at most
//
//   l (m w + integral over s > 0 of min(m, h^2 / (4 s^2))) = l (m w + h sqrt(m)).
class StripBound {
 public:
  enum class Sides { kFront, kBoth };  // from which the strip counts
  StripBound(const Sight& sight, const Ring& ring, const NearHorizon& near, const Plane& plane, Sides sides);

  // At least the integral of F of the strip over the cell, of at most this size.
  [[nodiscard]] double on(std::span<const Vec3> cell, double size) const;

 private:
  std::vector<FactorBound> strip_;  // from these sides
  Vec3 along_;                      // the line; of length 1
  double area_;
  double for_length_;  // the bound near the strip, over the length of the cell
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
