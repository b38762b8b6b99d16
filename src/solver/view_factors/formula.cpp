#include "view_factors/formula.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

BallPoint operator-(const BallPoint& a, const BallPoint& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
BallPoint operator+(const BallPoint& a, const BallPoint& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
BallPoint operator*(const BallPoint& a, const Ball& s) { return {a.x * s, a.y * s, a.z * s}; }
Ball dot(const BallPoint& a, const BallPoint& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
BallPoint cross(const BallPoint& a, const BallPoint& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Ball length(const BallPoint& a) { return sqrt(dot(a, a)); }

}  // namespace

BallPoint ball_point(const Point& point, long bits) {
  const auto coordinate = [&](std::size_t i) {
    const Ball numerator = kernel::to_ball(point.exact[i], bits);
    return point.exact[3] == 1 ? numerator : numerator / kernel::to_ball(point.exact[3], bits);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

Formula::Formula(const Sight& sight, const std::vector<BoundaryPart>& parts, bool has_horizon)
    : points_(sight.points), receiver_(sight.receiver), exact_parts_(parts), constant_(has_horizon ? 1.0 : 0.0) {
  const Vec3 n{receiver_.rounded[0], receiver_.rounded[1], receiver_.rounded[2]};
  normal_ = kernel::scaled(n, 1.0 / length(n));
  const auto segment = [&](PointId a, PointId b) {
    const Vec3 along = kernel::difference(points_[b].at, points_[a].at);
    return QuickPart::Segment{points_[a].at, along, length(along)};
  };
  const auto end = [&](const End& e) {
    if (!e.line) return QuickPart::End{.kind = QuickPart::End::Kind::kVertex, .at = points_[e.vertex].at, .other = {}};
    const Line& line = points_.line(*e.line);
    return QuickPart::End{.kind = QuickPart::End::Kind::kCrossing, .at = {}, .other = segment(line.a, line.b)};
  };
  for (const BoundaryPart& part : parts) {
    const auto& [from, to, line, along] = part.edge;
    parts_.push_back({segment(from, to), end(part.from), end(part.to), static_cast<double>(part.sign)});
    in_receiver_plane_.push_back(side_of(receiver_, points_[from]) == 0 && side_of(receiver_, points_[to]) == 0);
  }
  share_crossings();
}

// Where exactly two parts end at the crossing of two lines, on either line, so that their ends cancel each other.
void Formula::share_crossings() {
  struct Crossing {
    LineId low, high;
    std::size_t part;
    bool is_to;
  };
  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i < exact_parts_.size(); ++i) {
    for (const bool is_to : {false, true}) {
      const BoundaryPart& part = exact_parts_[i];
      const LineId own = part.edge.line;
      if (const std::optional<LineId> other = (is_to ? part.to : part.from).line) {
        crossings.push_back({std::min(own, *other), std::max(own, *other), i, is_to});
      }
    }
  }
  const auto lines = [](const Crossing& c) { return std::pair(c.low, c.high); };
  std::ranges::stable_sort(crossings, {}, lines);
  for (auto begin = crossings.begin(); begin != crossings.end();) {
    const auto end = std::find_if(begin, crossings.end(), [&](const Crossing& c) { return lines(c) != lines(*begin); });
    if (end - begin == 2) share(begin[0].part, begin[0].is_to, begin[1].part, begin[1].is_to);
    if (end - begin == 1 && in_receiver_plane_[begin->part] != 0) move_to_foot(begin->part, begin->is_to);
    begin = end;
  }
}

// Of an edge on the horizon: the other edge's corner in the receiver's plane, where it meets the horizon.
void Formula::move_to_foot(std::size_t part, bool is_to) {
  const LineId line = *(is_to ? exact_parts_[part].to : exact_parts_[part].from).line;
  for (const BoundaryPart& other : exact_parts_) {
    if (other.edge.line != line) continue;
    for (const PointId corner : {other.edge.from, other.edge.to}) {
      if (side_of(receiver_, points_[corner]) != 0) continue;
      end_of(part, is_to) = {.kind = QuickPart::End::Kind::kVertex, .at = points_[corner].at, .other = {}};
    }
  }
}

void Formula::share(std::size_t i, bool is_to_of_i, std::size_t j, bool is_to_of_j) {
  const BoundaryPart &one = exact_parts_[i], &other = exact_parts_[j];
  const bool cancel = (one.sign == other.sign) == (is_to_of_i != is_to_of_j);
  if (!cancel || one.edge.line == other.edge.line) return;
  using Kind = QuickPart::End::Kind;
  end_of(i, is_to_of_i) = {.kind = Kind::kSharedOnEdge, .at = {}, .other = parts_[j].edge};
  end_of(j, is_to_of_j) = {.kind = Kind::kSharedOnOther, .at = {}, .other = parts_[i].edge};
}

void Formula::at(std::span<const Vec3> points, std::span<Evaluated> values) const {
  evaluate(parts_, normal_, points, values);
  if (constant_ == 0.0) return;
  for (Evaluated& one : values) one = {one.value + constant_, one.rounding + 0x1p-52};
}

Evaluated Formula::at(const Vec3& x) const {
  Evaluated value;
  at({&x, 1}, {&value, 1});
  return value;
}

double Formula::distance_to_edges(const Vec3& x) const {
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Vec3& a = points_[exact_parts_[i].edge.from].at;
    const Vec3& b = points_[exact_parts_[i].edge.to].at;
    nearest = std::min(nearest, is_in_receiver_plane(i) ? std::min(kernel::distance(x, a), kernel::distance(x, b))
                                                        : distance_to_segment(x, a, b));
  }
  return nearest;
}

Ball Formula::at(const BallPoint& x) const {
  const long bits = x.x.bits();
  const auto place = [&](PointId id) { return ball_point(points_[id], bits) - x; };
  const BallPoint normal{kernel::to_ball(receiver_.exact[0], bits), kernel::to_ball(receiver_.exact[1], bits),
                         kernel::to_ball(receiver_.exact[2], bits)};
  Ball sum(bits);
  for (const BoundaryPart& part : exact_parts_) {
    const BallPoint a = place(part.edge.from), b = place(part.edge.to);
    const auto end = [&](const End& e) {
      if (!e.line) return place(e.vertex);
      const Line& line = points_.line(*e.line);
      const BallPoint other = cross(place(line.a), place(line.b));
      const Ball at_a = dot(other, a), at_b = dot(other, b);
      return a + (b - a) * (at_a / (at_a - at_b));
    };
    const BallPoint p = end(part.from), q = end(part.to), plane = cross(a, b);
    const Ball size = length(plane);
    const Ball term = atan2(dot(cross(p, q), plane) / size, dot(p, q)) * dot(plane, normal) / size;
    sum = part.sign > 0 ? sum - term : sum + term;
  }
  const Ball value = sum / (length(normal) * twice(kernel::pi(bits)));
  return constant_ == 0.0 ? value : value + kernel::to_ball(constant_, bits);
}

}  // namespace exactff::view_factors
