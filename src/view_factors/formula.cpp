#include "view_factors/formula.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

using kernel::cross;
using kernel::difference;
using kernel::dot;

// Of a difference of two points whose coordinates are at most 1 and carry a few roundings.
constexpr double kDifferenceError = 0x1p-50;

// A direction in double, and an estimate of the angle by which rounding may have turned it.
struct Sighting {
  Vec3 direction;
  double error = 0.0;
};

Sighting sighting(const Vec3& at, const Vec3& x) {
  const Vec3 d = difference(at, x);
  return {d, kDifferenceError / length(d)};
}

// Where the line through `c` and `d` crosses the edge from a to b, all seen from x.
Sighting crossing(const Vec3& c, const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& x) {
  const Vec3 p = difference(c, x), along = difference(d, c);
  const Vec3 plane = cross(p, along);
  const double at_a = dot(plane, a), at_b = dot(plane, b);
  const double weight = std::abs(at_a) + std::abs(at_b);
  if (!(weight > 0.0)) return {a, HUGE_VAL};
  const double t = std::abs(at_a) / weight;
  const Vec3 edge = difference(b, a);
  const Vec3 at{a.x + t * edge.x, a.y + t * edge.y, a.z + t * edge.z};
  const double of_plane = kDifferenceError * (length(p) + length(along)) * (length(a) + length(b)) / weight;
  return {at, (kDifferenceError + of_plane * length(edge)) / length(at)};
}

// --- The same in balls ---

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

Formula::Formula(const Sight& sight, const std::vector<BoundaryPart>& parts)
    : points_(sight.points), receiver_(sight.receiver), exact_parts_(parts) {
  const Vec3 n{receiver_.rounded[0], receiver_.rounded[1], receiver_.rounded[2]};
  normal_ = kernel::scaled(n, 1.0 / length(n));
  for (const BoundaryPart& part : parts) {
    Part made;
    made.edge = {points_[part.edge.from].at, points_[part.edge.to].at};
    made.sign = part.sign;
    made.in_receiver_plane =
        side_of(receiver_, points_[part.edge.from]) == 0 && side_of(receiver_, points_[part.edge.to]) == 0;
    const auto set = [&](const End& end, Segment& line, Vec3& at, bool& crosses) {
      crosses = end.line.has_value();
      if (crosses) {
        line = {points_[points_.line(*end.line).a].at, points_[points_.line(*end.line).b].at};
      } else {
        at = points_[end.vertex].at;
      }
    };
    set(part.from, made.from, made.from_at, made.from_crosses);
    set(part.to, made.to, made.to_at, made.to_crosses);
    parts_.push_back(made);
  }
}

// An edge that is seen counter-clockwise round the visible region has a normal a x b that points away from the
// region as seen from x. So the sum of angle * (a x b) . n / |a x b| is -2 pi F.
Evaluated Formula::at(const Vec3& x) const {
  double sum = 0.0, error = 0.0;
  for (const Part& part : parts_) {
    const Vec3 a = difference(part.edge.a, x), b = difference(part.edge.b, x);
    const Vec3 along = difference(part.edge.b, part.edge.a);
    const Vec3 plane = cross(a, along);
    const double size = length(plane);
    if (!(size > 0.0)) return {0.0, HUGE_VAL};
    const Sighting from = part.from_crosses ? crossing(part.from.a, part.from.b, a, b, x) : sighting(part.from_at, x);
    const Sighting to = part.to_crosses ? crossing(part.to.a, part.to.b, a, b, x) : sighting(part.to_at, x);
    const Vec3& p = from.direction;
    const Vec3& q = to.direction;
    const double angle = std::atan2(dot(cross(p, difference(q, p)), plane) / size, dot(p, q));
    const double cosine = dot(plane, normal_) / size;
    sum += part.sign * angle * cosine;
    error += std::abs(angle) * kDifferenceError * (length(a) + length(along)) / size +
             std::abs(cosine) * (from.error + to.error);
  }
  return {-sum / (2.0 * std::numbers::pi), error / (2.0 * std::numbers::pi)};
}

double Formula::distance_to_edges(const Vec3& x) const {
  double nearest = HUGE_VAL;
  for (const Part& part : parts_) {
    const auto& [a, b] = part.edge;
    nearest = std::min(nearest, part.in_receiver_plane ? std::min(kernel::distance(x, a), kernel::distance(x, b))
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
  return sum / (length(normal) * twice(kernel::pi(bits)));
}

}  // namespace exactff::view_factors
