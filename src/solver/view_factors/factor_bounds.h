// Upper bounds of form factors, whatever hides the source, by distance and slope alone.
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

// --- Patch bounds ---

// What is proved of the factor of a patch on small tiles of another one, whatever lies between.

class PatchBounds {
 public:
  // Keeps references.
  PatchBounds(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to);

  // At least F(x -> to) for every x of the convex hull of corners in this part of `from`; at most 1.
  [[nodiscard]] double on(std::size_t part, std::span<const Vec3> corners);
  // About the mean of this over `from`, by a few points.
  [[nodiscard]] double mean();

 private:
  // Of each part of `to` that lies before the part, as that does before it.
  [[nodiscard]] const std::vector<UnhiddenBound>& of(std::size_t part);

  const ExactScene& scene_;
  const PreparedPatch &from_, &to_;
  std::vector<std::optional<std::vector<UnhiddenBound>>> parts_;  // made when asked for
};

}  // namespace exactff::view_factors
