// Convex polygons that share a table of points and lines.
//
// The line of an edge is the one through the two points that first defined it, even if clipping has shortened the edge:
// their coordinates are short. Edges along one another, as neighbouring faces have them, share their line.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "view_factors/exact_space.h"

namespace exactff::view_factors {

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
  [[nodiscard]] Plane plane_of(const Ring& ring) const;
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
