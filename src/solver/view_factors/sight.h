// What lies between two convex pieces: the pair's polygons, clipped once by each other's planes.
//
// Backs of closed surfaces. Let S be a closed surface with winding number w (scene/closed_surfaces.h). Let w(x) and
// w(y) be the values just above a point x of the receiver and just before a point y of the source. On almost every
// segment from x to y, w grows by one at each piece that is crossed from the front and falls by one at each that is
// crossed from the back. If w(y) >= w(x), then, a segment that S blocks is crossed from the front at least once: pieces
// that show x their backs cover nothing that the others do not cover, up to a set of area zero, and may be left out.
//
// - w is 0 outside the box of S.
// - Let S lie on the front side of the receiver's plane, or in it. Behind the plane w is 0. So it is 0 above x as well
//   if x is in none of the pieces of S in this plane, its bases.
// - Let S lie on the front side of the source's plane, or in it. Then w(y) is the number of bases there that hold y,
//   those with the front towards x counting as -1: it is at least 0 if all of them face away.
//
// Pieces in the receiver's plane do not occlude. If the receiver's piece belongs to S, it is a base that holds every x,
// and nothing is left out. For a surface that is turned inside out, all this holds with fronts and backs exchanged.
//
// Of what is open, y is so far away that w(y) is 0.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "view_factors/cell.h"
#include "view_factors/exact_scene.h"

namespace exactff::view_factors {

inline constexpr std::uint32_t kNoSolid = std::numeric_limits<std::uint32_t>::max();

struct Occluder {
  Ring ring;           // counter-clockwise as seen from the positive side of the plane
  const Plane* plane;  // of the scene
  std::uint32_t solid = kNoSolid;
};

// A closed surface whose backs may be left out for cells outside all of its bases.
struct Solid {
  bool turned_inside_out = false;
  std::vector<Ring> bases;  // in the receiver's plane, counter-clockwise as seen from its front
};

// Sides of a polygon, one after the other, that are in the receiver's plane or almost so, but not all in it: with the
// sides before and after extended as far as this plane, the polygon would end in it.
struct NearHorizon {
  std::size_t first, count;  // by their places in the ring
  Edge in_plane;             // instead of them
};

// An occluder that would end in the receiver's plane.
struct WidenedOccluder {
  std::uint32_t original;
  NearHorizon near;
  Occluder occluder;
};

// A receiver's points see a source's points, or all that lies in a direction, if the segment between them meets no
// occluder. Refers to the scene.
struct Sight {
  explicit Sight(const Units& units) : points(units) {}

  Points points;
  Plane receiver, source_plane;  // positive in front; the second: if there is a source
  Cell root;                     // the part of the receiver in front of the source's plane
  Ring source;  // the part of the source in front of the receiver's plane, counter-clockwise as seen from there
  std::optional<NearHorizon> near_horizon;  // of the source
  std::vector<Occluder> occluders;          // the parts in front of both planes
  std::vector<WidenedOccluder> widened;     // of some of them
  std::vector<Solid> solids;
  PointId apex = 0;  // a point in front of the receiver's plane, of the source if there is one

  // What the occluders leave open of all directions is asked for: there is no source.
  [[nodiscard]] bool is_of_open() const { return source.empty(); }
  // The occluders, then the widened ones.
  [[nodiscard]] std::uint32_t shadow_count() const {
    return static_cast<std::uint32_t>(occluders.size() + widened.size());
  }
  [[nodiscard]] const Occluder& shadow(std::uint32_t id) const {
    return id < occluders.size() ? occluders[id] : widened[id - occluders.size()].occluder;
  }
};

// A convex part of a patch: corners counter-clockwise as seen from the front, none in the middle of a straight side.
struct Part {
  FaceId face{};      // of a part of a joined panel one of several: see faces_of
  PanelId panel = 0;  // that it is a part of
  std::vector<Point> corners;
  bool is_piece = false;  // the whole panel
  bool is_cut = false;    // a fragment of cut_at_contacts(), or a cell
  double weight = 1.0;    // of its area, in means over several
};

// Of its panel. Not for parts that were made of no panel, as cells are.
[[nodiscard]] const Plane& plane_of(const ExactScene& scene, const Part& part);

// The faces that it is a part of: of a joined panel all of its sheet, which lie in its plane.
[[nodiscard]] std::vector<FaceId> faces_of(const Scene& scene, const Part& part);

// Empty if no point of the receiver lies in front of the source, or the other way round: the factor is 0. `pieces`: all
// that may occlude, by ascending index (seen_parts.h).
[[nodiscard]] std::optional<Sight> sight_of(const ExactScene& scene, std::span<const std::uint32_t> pieces,
                                            const Part& receiver, const Part& source);
// Of all directions in front of the receiver.
[[nodiscard]] Sight sight_of_open(const ExactScene& scene, std::span<const std::uint32_t> pieces, const Part& receiver);

// --- Pair shaft ---

// The shaft between two boxes (Haines and Wallace): half-spaces that hold their hull, found in each pair of axes. What
// lies outside one of them does not lie between the boxes.

class PairShaft {
 public:
  PairShaft(const Box& a, const Box& b);

  // Certainly: no coordinate exceeds 1, and the margin is larger than all roundings.
  [[nodiscard]] bool is_outside(const Box& box) const;

 private:
  // The points with normal[0] (y_first - origin[0]) + normal[1] (y_second - origin[1]) <= limit.
  struct HalfSpace {
    int first, second;  // axes
    std::array<double, 2> normal, origin;
    double limit;
  };
  // Of a product of the normal with points of the box; the least if `sign` is -1, the largest if it is 1.
  [[nodiscard]] static double extreme(const HalfSpace& half_space, const Box& box, int sign);

  std::vector<HalfSpace> half_spaces_;
};

}  // namespace exactff::view_factors
