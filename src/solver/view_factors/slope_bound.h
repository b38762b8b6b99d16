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
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "kernel/vec.h"
#include "view_factors/sight.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {

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

  struct Side {
    Vec3 normal;  // of length 1
    double offset;

    [[nodiscard]] double height(const Vec3& x) const { return kernel::dot(normal, x) + offset; }
  };
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

  [[nodiscard]] static Side side_of(const Plane& plane);
  [[nodiscard]] static Segment segment_of(const Sight& sight, const Edge& edge);
  [[nodiscard]] static std::vector<Segment> edges_of_occluders(const Sight& sight);
  [[nodiscard]] static std::vector<Segment> cut(const std::vector<Segment>& segments);
  [[nodiscard]] std::vector<Beside> planes_beside(const Vec3& centre) const;
  [[nodiscard]] static bool is_hidden(const Segment& segment, const Vec3& centre, double radius);
  [[nodiscard]] static double slope(const Segment& piece, const Vec3& centre, double radius);

  std::vector<Vec3> source_;                       // its corners
  std::vector<Segment> of_source_, of_occluders_;  // pieces of edges
};

}  // namespace exactff::view_factors
