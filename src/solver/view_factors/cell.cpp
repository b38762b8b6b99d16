#include "view_factors/cell.h"

#include <algorithm>
#include <cmath>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

using kernel::coordinate;
using kernel::cross;
using kernel::difference;
using kernel::distance;
using kernel::dot;

double value_at(const Plane& plane, const Vec3& p) {
  return plane.rounded[0] * p.x + plane.rounded[1] * p.y + plane.rounded[2] * p.z + plane.rounded[3];
}

// The number with the fewest bits within an eighth of the range from its middle.
double short_number_near(double low, double high) {
  const double middle = 0.5 * (low + high), width = high - low;
  const double step = std::ldexp(1.0, std::ilogb(width) - 2);  // between an eighth and a quarter of the width
  return std::round(middle / step) * step;
}

// The smaller of the parts' areas, over the whole, of the parts where a function is negative and where it is not.
template <class Value>
double smaller_share(const Cell& cell, const Value& value) {
  std::vector<Vec3> positive;
  const std::size_t count = cell.corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = cell.corners[i].at;
    const Vec3& q = cell.corners[(i + 1) % count].at;
    const double here = value(p), next = value(q);
    if (here >= 0.0) positive.push_back(p);
    if ((here < 0.0) == (next < 0.0)) continue;
    const double t = here / (here - next);
    positive.push_back(kernel::along(p, difference(q, p), t));
  }
  const double whole = area(cell);
  const double part = whole > 0.0 ? area(positive) / whole : 0.0;
  return std::min(part, 1.0 - part);
}

}  // namespace

Cell cell_of(const Points& points, const Ring& ring, const Plane& receiver) {
  Cell cell;
  for (const Edge& edge : ring) {
    const Point& from = points[edge.from];
    const Line& line = points.line(edge.line);
    const Point& origin = points[edge.along ? line.a : line.b];
    Homogeneous above = origin.exact;  // a point of the line, moved along the receiver's normal
    for (std::size_t i = 0; i < 3; ++i) above[i] += receiver.exact[i] * origin.exact[3];
    const Homogeneous side =
        join(origin, points[edge.along ? line.b : line.a], make_point(std::move(above), points.units()));
    cell.corners.push_back(from);
    cell.sides.push_back(std::make_shared<const Plane>(make_plane(side, points.units())));
  }
  return cell;
}

int sign_inside(const Plane& plane, const Cell& cell) {
  return common_sign(cell, [&](const Point& corner) { return side_of(plane, corner); });
}

Halves cut(const Cell& cell, const Plane& receiver, const std::shared_ptr<const Plane>& by, const Units& units) {
  Halves halves;
  const std::size_t count = cell.corners.size();
  std::vector<int> sides;
  for (const Point& corner : cell.corners) sides.push_back(side_of(*by, corner));
  const auto add = [&](Cell& half, const Point& corner, const std::shared_ptr<const Plane>& side) {
    half.corners.push_back(corner);
    half.sides.push_back(side);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const int here = sides[i], next = sides[(i + 1) % count];
    const Point& corner = cell.corners[i];
    // A half's boundary leaves along the cut where the next corner lies on the other side.
    if (here >= 0) add(halves.positive, corner, here == 0 && next < 0 ? by : cell.sides[i]);
    if (here <= 0) add(halves.negative, corner, here == 0 && next > 0 ? by : cell.sides[i]);
    if (here * next >= 0) continue;
    const Point crossing = make_point(meet(receiver, *cell.sides[i], *by), units);
    add(halves.positive, crossing, here > 0 ? by : cell.sides[i]);
    add(halves.negative, crossing, here < 0 ? by : cell.sides[i]);
  }
  return halves;
}

double distance_from_sides(const Cell& cell, const Vec3& x) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    const Vec3& next = cell.corners[(i + 1) % cell.corners.size()].at;
    least = std::min(least, distance_to_segment(x, cell.corners[i].at, next));
  }
  return least;
}

std::vector<Vec3> positions_of(const std::vector<Point>& points) {
  std::vector<Vec3> result;
  for (const Point& point : points) result.push_back(point.at);
  return result;
}

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 along = difference(b, a);
  const double squared = dot(along, along);
  const double t = squared > 0.0 ? std::clamp(dot(difference(x, a), along) / squared, 0.0, 1.0) : 0.0;
  return distance(x, kernel::along(a, along, t));
}

double area(const std::vector<Vec3>& ring) {
  Vec3 sum;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    sum = kernel::sum(sum, cross(difference(ring[i - 1], ring[0]), difference(ring[i], ring[0])));
  }
  return 0.5 * length(sum);
}

double balance(const Cell& cell, const Plane& plane) {
  return smaller_share(cell, [&](const Vec3& p) { return value_at(plane, p); });
}

double balance_at_most(const Cell& cell, const RoundedPlane& plane) {
  constexpr double kCertain = 0x1p20, kMargin = 0x1p-10;
  const bool says_something =
      std::ranges::any_of(cell.corners, [&](const Point& corner) { return plane.is_beyond(corner.at, kCertain); });
  if (!says_something) return 1.0;
  return smaller_share(cell, [&](const Vec3& p) { return plane.height(p); }) + kMargin;
}

std::shared_ptr<const Plane> bisector(const Cell& cell, const Units& units) {
  int widest = 0;
  double low = 0.0, high = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    double least = coordinate(cell.corners[0].at, axis), most = least;
    for (const Point& corner : cell.corners) {
      least = std::min(least, coordinate(corner.at, axis));
      most = std::max(most, coordinate(corner.at, axis));
    }
    if (axis > 0 && !(most - least > high - low)) continue;
    widest = axis;
    low = least;
    high = most;
  }
  if (!(high > low)) return nullptr;
  const kernel::BinaryDouble place = kernel::decompose(short_number_near(low, high));
  // x_axis = place * 2^shift integer units
  Homogeneous plane;
  const long exponent = place.mantissa == 0 ? 0 : place.exponent + units.shift;
  plane[static_cast<std::size_t>(widest)] =
      exponent < 0 ? Integer(1) << static_cast<unsigned long>(-exponent) : Integer(1);
  plane[3] = -Integer(place.mantissa) << static_cast<unsigned long>(std::max(exponent, 0L));
  auto result = std::make_shared<const Plane>(make_plane(std::move(plane), units));
  return sign_inside(*result, cell) == kMixed ? result : nullptr;
}

}  // namespace exactff::view_factors
