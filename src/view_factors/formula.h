// Tampieri's Eq. (4) over a boundary that is constant on a cell, as a function of x.
#pragma once

#include <vector>

#include "kernel/ball.h"
#include "view_factors/cell_view.h"

namespace exactff::view_factors {

// A point in balls, in integer units (exact_space.h).
struct BallPoint {
  Ball x, y, z;
};
[[nodiscard]] BallPoint ball_point(const Point& point, long bits);

struct Evaluated {
  double value = 0.0;
  double rounding = 0.0;  // an estimate of the error that rounding makes
};

// For points of a cell: F(x -> visible part of the source). Analytic inside the cell. Where the ends of a part have
// changed places, it counts with the opposite sign (event_bound.h).
class Formula {
 public:
  // Keeps a reference to the points.
  Formula(const Sight& sight, const std::vector<BoundaryPart>& parts);

  // In double. The estimate is large where edges almost meet the point, or hide one another but for a sliver.
  [[nodiscard]] Evaluated at(const Vec3& x) const;
  [[nodiscard]] Ball at(const BallPoint& x) const;
  // The distance to the nearest point near which F changes fast: of an edge, or of the ends alone of one that lies in
  // the receiver's plane, since F is analytic up to such an edge. In the unit of Point::at.
  [[nodiscard]] double distance_to_edges(const Vec3& x) const;

  // What it is made of.
  [[nodiscard]] const Points& points() const { return points_; }
  [[nodiscard]] const Plane& receiver() const { return receiver_; }
  [[nodiscard]] const std::vector<BoundaryPart>& boundary() const { return exact_parts_; }
  [[nodiscard]] bool is_in_receiver_plane(std::size_t part) const { return parts_[part].in_receiver_plane; }

 private:
  struct Segment {
    Vec3 a, b;
  };
  struct Part {
    Segment edge;         // from the first end of the edge to its second
    Segment from, to;     // lines that cross it, if `from_crosses`, `to_crosses`
    Vec3 from_at, to_at;  // else its ends
    bool from_crosses = false, to_crosses = false;
    bool in_receiver_plane = false;
    double sign = 1.0;
  };

  const Points& points_;
  const Plane& receiver_;
  std::vector<BoundaryPart> exact_parts_;
  std::vector<Part> parts_;
  Vec3 normal_;  // of the receiver, of length 1
};

}  // namespace exactff::view_factors
