// Tampieri's Eq. (4) over a boundary that is constant on a cell, as a function of x.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/ball.h"
#include "view_factors/cell_view.h"
#include "view_factors/quick_formula.h"

namespace exactff::view_factors {

// A point in balls, in integer units (exact_scene.h).
struct BallPoint {
  Ball x, y, z;
};
[[nodiscard]] BallPoint ball_point(const Point& point, long bits);

// For points of a cell: F(x -> visible part of the source). Analytic inside the cell. Where the ends of a part have
// changed places, it counts with the opposite sign (cell.h).
class Formula {
 public:
  // Keeps a reference to the points.
  Formula(const Sight& sight, const std::vector<BoundaryPart>& parts, bool has_horizon = false);

  // In double. The rounding is large where edges almost meet the point, or hide one another but for a sliver.
  void at(std::span<const Vec3> points, std::span<Evaluated> values) const;
  [[nodiscard]] Evaluated at(const Vec3& x) const;
  [[nodiscard]] Ball at(const BallPoint& x) const;
  // The distance to the nearest point near which F changes fast: of an edge, or of the ends alone of one that lies in
  // the receiver's plane, since F is analytic up to such an edge. In the unit of Point::at.
  [[nodiscard]] double distance_to_edges(const Vec3& x) const;

  // What it is made of.
  [[nodiscard]] const Points& points() const { return points_; }
  [[nodiscard]] const Plane& receiver() const { return receiver_; }
  [[nodiscard]] const std::vector<BoundaryPart>& boundary() const { return exact_parts_; }
  // What the parts are added to: 1 for the whole horizon.
  [[nodiscard]] double constant() const { return constant_; }
  [[nodiscard]] bool is_in_receiver_plane(std::size_t part) const { return in_receiver_plane_[part] != 0; }

 private:
  void share_crossings();
  void share(std::size_t i, bool is_to_of_i, std::size_t j, bool is_to_of_j);
  void move_to_foot(std::size_t part, bool is_to);
  QuickPart::End& end_of(std::size_t part, bool is_to) { return is_to ? parts_[part].to : parts_[part].from; }

  const Points& points_;
  const Plane& receiver_;
  std::vector<BoundaryPart> exact_parts_;
  std::vector<QuickPart> parts_;
  std::vector<std::uint8_t> in_receiver_plane_;  // by part
  Vec3 normal_;                                  // of the receiver, of length 1
  double constant_;
};

}  // namespace exactff::view_factors
