// What is left out of a cell's view, as it hides next to nothing: the bounds, and the choice.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "view_factors/cell_view.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

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
// By its height. Let no point of the occluder be higher above the receiver's plane than h, and let a line in this plane
// have the occluder's projection on one side. From x on its other side, at the distance t > 0, the occluder is seen
// below an elevation a, tan a <= h / t, in a lune between the horizon and a plane through x along the line. So it hides
// at most (1 - cos a) / 2 <= a^2 / 4 <= h^2 / (4 t^2), and nothing if the source is seen above this elevation: its
// corners are higher than k, say, and nearer than d, so t > h d / k is enough. Where F of the source is at most m, the
// integral over a strip of the width w along the line is thus at most
//
//   w * integral over t > 0 of min(m, h^2 / (4 t^2)) = w h sqrt(m),
//
// and w h^2 / 4 (1 / t - 1 / u) from t to u; or m times its area. Any line will do, with m times the area on the
// occluder's side of it; or all sides of the projection, with m times the area of what it covers.
//
// Likewise for the source: as A_i F_ij = A_j F_ji, what is hidden from the cell of the source is what is hidden from
// the source of the cell. A small cell is little of what the source sees.
//
// Roundings. A height errs by less than 2^-46. The parts are those where it is at most kOfHeight as computed: a place
// between the ends of a side where linear interpolation says kOfHeight is above 0 in truth. Areas get a margin of
// kOfHeight, as a side is at most 2 long.

// An occluder that is low above a plane.
class LowOccluder {
 public:
  LowOccluder(const Side& above, std::span<const Vec3> occluder);

  [[nodiscard]] double height() const { return height_; }
  // At least the integral over the convex polygon in the plane of what is hidden of the convex target.
  [[nodiscard]] double hidden_from(std::span<const Vec3> polygon, std::span<const Vec3> target,
                                   const FactorBound& of_target) const;

 private:
  static constexpr double kNear = 0x1p-6;  // where m is asked for, if the target is not high

  Side above_;
  double height_ = 0.0;
  std::vector<Side> around_;  // positive outside of its projection: along its sides, and opposite to each
};

class HiddenBound {
 public:
  // There must be a source, in this plane, which is referred to as the sight is. `directions`: of length 1, each tried
  // both ways.
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
  const Plane &receiver_, &source_plane_;
  std::vector<Vec3> source_;
  FactorBound of_source_;
  std::optional<LowOccluder> above_receiver_, above_source_;
  bool may_be_small_ = false;
};

// What one occluder hides, and another one does not, as where two walls meet at a corner of a room, but for roundings.
//
// Let h = 0 be the plane of the outer occluder. A segment that meets the inner one begins where h <= 0, or ends at a
// point of the inner one where h >= 0, or crosses the plane in between, in the hull of the cell and the inner occluder.
// If the outer one does not block it, it crosses outside of it. Of all these segments, those that pass a set of places
// in a plane carry at most the area of the set, by A_i F_ij = A_j F_ji; and where the set is at least d away, and no
// higher than h above the receiver's plane, at most the cell's area times that of the set over pi d^2, times h / d.
// Sets are slivers, and counted piece by piece. So with K the outer occluder, and K' the
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

  // Places in a plane about a segment, of which each point may count from either side as often as the areas say.
  struct Sliver {
    Vec3 from, to;
    double thickness;      // no place is farther from the segment
    double area, density;  // at most all, and that of the places beside a piece of the segment, over its length

    static Sliver of(std::span<const Vec3> convex, double times);
  };
  // At least what passes a sliver from a cell of this size.
  struct Flux {
    const Side& receiver;
    Box cell;
    double size, aside;
    [[nodiscard]] double through(const Sliver& sliver, const Vec3& from, const Vec3& to, int times_to_halve) const;
  };
  // Without corners that are almost those before.
  void take_outline(std::vector<Vec3> outline);
  // Of the places in the plane that are no farther outwards than this.
  [[nodiscard]] std::vector<Vec3> within(std::span<const double> reach) const;

  Side plane_;
  std::vector<Vec3> outwards_;  // of each side
  std::vector<double> sides_;   // and its height
  std::vector<Vec3> inner_;
  Side receiver_;
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

// --- Left out ---

// Candidates that are left out of a cell's view, since they hide little, or little that others do not hide, or instead
// of which widened ones are there.
struct LeftOut {
  static constexpr std::uint32_t kByItself = static_cast<std::uint32_t>(-1), kWidened = static_cast<std::uint32_t>(-2);

  Candidates candidates;
  std::vector<std::uint32_t> covers;  // of each: a cover of the pair, or one of the above
  double over = 0.0, under = 0.0;     // by how much the integral may be too large, or too small

  [[nodiscard]] double width() const { return over + under; }
};

// What bounds ask of a cell.
struct Extent {
  std::vector<Vec3> corners;
  double most;  // at least F of the whole source from any point of it
  double size;  // at least its area
};

// What may be left out of the cells of a pair. Bounds are found when they are first asked for.
class Omissions {
 public:
  // Keeps references.
  Omissions(const Sight& sight, const CellView& view) : sight_(sight), view_(view) {}

  [[nodiscard]] bool are_possible();
  // Takes out of the candidates those that hide least, as many as may hide the trifle, and puts widened ones in.
  [[nodiscard]] LeftOut leave_out(const Extent& cell, Candidates& candidates, double trifle);
  // Its bounds, for the cell.
  void bound(LeftOut& left_out, const Extent& cell) const;
  // All candidates again.
  [[nodiscard]] Candidates united(const Candidates& candidates, const LeftOut& left_out) const;

 private:
  struct Cover {
    std::uint32_t inner;
    std::vector<std::uint32_t> outer;
    CoverBound bound;
  };
  [[nodiscard]] bool has_near_misses(const Plane& source_plane) const;
  void find_bounds();
  void find_covers();

  const Sight& sight_;
  const CellView& view_;
  bool has_bounds_ = false;
  std::vector<std::pair<std::uint32_t, HiddenBound>> hidden_;  // by occluders that may hide little, ascending
  std::vector<Cover> covers_;
  std::vector<std::pair<std::uint32_t, StripBound>> widened_;  // by occluders, in the order of Sight::widened
};

}  // namespace exactff::view_factors
