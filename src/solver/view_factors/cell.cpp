#include "view_factors/cell.h"

#include <algorithm>
#include <bit>
#include <numbers>

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

double error_of_area(const std::vector<Vec3>& ring) {
  double perimeter = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) perimeter += kernel::distance(ring[i], ring[(i + 1) % ring.size()]);
  return perimeter * 0x1p-50;
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

// --- Crossing order ---

namespace {

using Exact3 = std::array<Integer, 3>;

constexpr double kError = 0x1p-50;  // e of the header
constexpr double kUnderflow = 0x1p-1000;
constexpr double kOfTheBound = 1.0 + 0x1p-40;  // more than its roundings

// Times the product of both last coordinates.
Exact3 difference(const Homogeneous& a, const Homogeneous& b) {
  Exact3 result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] * b[3] - b[i] * a[3];
  return result;
}
Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Integer dot(const Exact3& a, const Exact3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Bounded {
  double value = 0.0, error = 0.0;
};

// f in doubles, with the bound of the header, and in integers.
struct Rounded {
  struct Edge {
    Vec3 a, along;
    double length;  // L
  };
  std::array<Edge, 3> edges;

  [[nodiscard]] Bounded at(const Vec3& x) const {
    std::array<Vec3, 3> n;
    std::array<double, 3> r{}, s{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 d = kernel::difference(edges[i].a, x);
      const double size = kernel::max_norm(d) + kError;  // A
      n[i] = kernel::cross(d, edges[i].along);
      r[i] = 4.0 * kError * (size + edges[i].length);
      s[i] = 2.0 * size * edges[i].length + r[i];
    }
    const double inherited = r[0] * s[1] * s[2] + s[0] * r[1] * s[2] + s[0] * s[1] * r[2];
    return {kernel::dot(n[0], kernel::cross(n[1], n[2])), 6.0 * (inherited + 2.0 * kError * s[0] * s[1] * s[2])};
  }
};
struct Exact {
  std::array<const Homogeneous*, 6> ends{};

  // Times the sixth power of the last coordinate of x, and a factor that does not depend on x.
  [[nodiscard]] Integer at(const Homogeneous& x) const {
    const auto normal = [&](std::size_t i) { return cross(difference(*ends[i], x), difference(*ends[i + 1], x)); };
    return dot(normal(0), cross(normal(2), normal(4)));
  }
};

// The common sign of numbers of which some may be 0, told one by one.
class CommonSign {
 public:
  // False once there are two signs.
  bool take(int sign) {
    if (sign == 0 || sign == found_) return true;
    if (found_ != 0) mixed_ = true;
    found_ = sign;
    return !mixed_;
  }
  [[nodiscard]] int sign() const { return mixed_ ? kMixed : found_; }

 private:
  int found_ = 0;
  bool mixed_ = false;
};

// The signs of the coefficients b(c_i, c_j) of f's polar form: by the filter, exactly where this declines.
class PolarSigns {
 public:
  PolarSigns(const std::array<const Point*, 6>& ends, const Cell& cell) : ends_(ends), cell_(cell) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 along = kernel::difference(ends[2 * i + 1]->at, ends[2 * i]->at);
      rounded_.edges[i] = {ends[2 * i]->at, along, kernel::max_norm(along) + kError};
    }
    for (const Point& corner : cell.corners) at_corners_.push_back(rounded_.at(corner.at));
  }

  [[nodiscard]] int sign(std::size_t i, std::size_t j) const {
    const Bounded b = estimate(i, j);
    if (std::abs(b.value) > b.error * kOfTheBound + kUnderflow) return b.value > 0.0 ? 1 : -1;
    return sgn(exact(i, j));
  }

 private:
  [[nodiscard]] Bounded estimate(std::size_t i, std::size_t j) const {
    const Bounded &at_y = at_corners_[i], &at_z = at_corners_[j];
    if (i == j) return at_y;
    const Vec3 &y = cell_.corners[i].at, &z = cell_.corners[j].at;
    const Bounded middle = rounded_.at({0.5 * (y.x + z.x), 0.5 * (y.y + z.y), 0.5 * (y.z + z.z)});
    return {2.0 * middle.value - 0.5 * (at_y.value + at_z.value), 2.0 * middle.error + 0.5 * (at_y.error + at_z.error)};
  }

  // Of the same sign. With w the last coordinate of both corners, that of their middle is 2 w, and the polar form is a
  // positive multiple of 2 f(middle) / 2^6 - (f(y) + f(z)) / 2.
  [[nodiscard]] Integer exact(std::size_t i, std::size_t j) const {
    Exact f;
    for (std::size_t k = 0; k < 6; ++k) f.ends[k] = &ends_[k]->exact;
    const Homogeneous &y = cell_.corners[i].exact, &z = cell_.corners[j].exact;
    if (i == j) return f.at(y);
    Homogeneous wide_y, wide_z, middle;
    for (std::size_t k = 0; k < 4; ++k) {
      wide_y[k] = y[k] * z[3];
      wide_z[k] = z[k] * y[3];
      middle[k] = wide_y[k] + wide_z[k];
    }
    return f.at(middle) - 16 * (f.at(wide_y) + f.at(wide_z));
  }

  const std::array<const Point*, 6>& ends_;
  const Cell& cell_;
  Rounded rounded_;
  std::vector<Bounded> at_corners_;
};

}  // namespace

int crossing_order(const Points& points, const Cell& cell, LineId e, LineId g, LineId h) {
  std::array<const Point*, 6> ends{};
  std::size_t count = 0;
  for (const LineId line : {e, g, h}) {
    for (const PointId id : {points.line(line).a, points.line(line).b}) ends[count++] = &points[id];
  }
  const PolarSigns signs(ends, cell);
  CommonSign common;
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    if (!common.take(signs.sign(i, i))) return kMixed;
  }
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    for (std::size_t j = i + 1; j < cell.corners.size(); ++j) {
      if (!common.take(signs.sign(i, j))) return kMixed;
    }
  }
  return common.sign();
}

// --- Event bound ---

namespace {

constexpr double kInfinity = HUGE_VAL;
constexpr double kRoundings = 0x1p-34;  // of a coefficient of a polar form, eight times
constexpr double kMargin = 1.0 + 0x1p-20;

class EventBounds {
 public:
  EventBounds(const Points& points, const Cell& cell, const Vec3& centre)
      : points_(points), corners_(positions_of(cell.corners)), centre_(centre) {}

  [[nodiscard]] double largest_order(const CrossingTriple& t) const {
    const auto f = [&](const Vec3& x) { return dot(normal(t[0], x), cross(normal(t[1], x), normal(t[2], x))); };
    double largest = 0.0;
    for_each_coefficient(f, corners_, [&](double b) {
      largest = std::max(largest, std::abs(b));
      return true;
    });
    return largest + kRoundings;
  }

  [[nodiscard]] double largest_normal(LineId line) const {
    double largest = 0.0;
    for (const Vec3& corner : corners_) largest = std::max(largest, length(normal(line, corner)));
    return largest * kMargin;
  }

  [[nodiscard]] double least_cross(LineId g, LineId h) const {
    const Vec3 at_centre = cross(normal(g, centre_), normal(h, centre_));
    const double size = length(at_centre);
    if (!(size > 0.0)) return 0.0;
    const Vec3 direction = kernel::scaled(at_centre, 1.0 / size);
    double least = kInfinity;
    const auto component = [&](const Vec3& x) { return dot(cross(normal(g, x), normal(h, x)), direction); };
    for_each_coefficient(component, corners_, [&](double b) {
      least = std::min(least, b);
      return true;
    });
    return least / kMargin - kRoundings;
  }

 private:
  [[nodiscard]] Vec3 normal(LineId line, const Vec3& x) const {
    const Line& ends = points_.line(line);
    return cross(kernel::difference(points_[ends.a].at, x), kernel::difference(points_[ends.b].at, x));
  }

  const Points& points_;
  std::vector<Vec3> corners_;
  Vec3 centre_;
};

// The lengths of the triangle's sides, together.
double perimeter(const TriangleBounds& bounds) {
  if (!std::ranges::all_of(bounds.cross, [](double cross) { return cross > 0.0; })) return kInfinity;
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double denominator = bounds.cross[i] * bounds.cross[(i + 2) % 3];
    if (!(denominator > 0.0)) return kInfinity;
    const double sine = bounds.normal[i] * bounds.order / denominator;
    if (!(sine < 0.5)) return kInfinity;
    sum += std::asin(sine);
  }
  return sum * kMargin;
}

bool share_a_line(const std::vector<CrossingTriple>& triples) {
  std::vector<LineId> lines;
  for (const CrossingTriple& t : triples) lines.insert(lines.end(), t.begin(), t.end());
  std::ranges::sort(lines);
  return std::ranges::adjacent_find(lines) != lines.end();
}

}  // namespace

TriangleBounds triangle_bounds(const Points& points, const Cell& cell, const Vec3& centre,
                               const CrossingTriple& triple) {
  const EventBounds bounds(points, cell, centre);
  TriangleBounds result;
  result.order = bounds.largest_order(triple);
  for (std::size_t i = 0; i < 3; ++i) {
    result.normal[i] = bounds.largest_normal(triple[i]);
    result.cross[i] = bounds.least_cross(triple[i], triple[(i + 1) % 3]);
  }
  return result;
}

double event_bound(const Points& points, const Cell& cell, const Vec3& centre, std::vector<CrossingTriple> triples) {
  std::ranges::sort(triples);
  triples.erase(std::unique(triples.begin(), triples.end()), triples.end());
  const bool shared = share_a_line(triples);
  double sum = 0.0;
  for (const CrossingTriple& triple : triples) {
    const double sides = perimeter(triangle_bounds(points, cell, centre, triple));
    sum += shared ? sides / std::numbers::pi : sides * sides / (std::numbers::pi * std::numbers::pi);
  }
  return sum;
}

// --- Pair memory ---

namespace {

constexpr std::size_t kMostEntries = std::size_t{1} << 18;  // 6 MB
constexpr std::size_t kMostPlanes = std::size_t{1} << 14;   // some 5 MB

}  // namespace

void PairMemory::take(std::size_t pair, std::size_t line_count, std::size_t point_count) {
  pair_ = pair;
  point_count_ = point_count;
  const std::size_t wanted = std::min(std::bit_ceil(line_count * point_count), kMostEntries);
  if (wanted > entries_.size()) entries_.assign(wanted, {});
}

void PairMemory::start(std::size_t pair, std::size_t line_count, std::size_t point_count) {
  take(pair, line_count, point_count);
  enter(0);
}

// Cells have numbers of their own, so what other pairs have left behind is about none on the way.
void PairMemory::resume(std::size_t pair, std::size_t line_count, std::size_t point_count, Way way) {
  EXACTFF_EXPECT(!way.empty());
  take(pair, line_count, point_count);
  depth_ = way.size() - 1;
  way_ = std::move(way);
}

void PairMemory::enter(std::size_t depth) {
  EXACTFF_EXPECT(depth <= way_.size() && depth < std::size_t{1} << kDepthBits);
  depth_ = depth;
  way_.resize(depth);
  way_.push_back(++cells_ << kDepthBits | depth);
}

int PairMemory::sign(LineId line, PointId point) const {
  const Entry& entry = entries_[slot(line, point)];
  if (entry.key != key(line, point)) return kUnasked;
  const std::size_t depth = entry.cell & ((std::size_t{1} << kDepthBits) - 1);
  if (depth > depth_ || way_[depth] != entry.cell) return kUnasked;
  return entry.sign >= kMixed && depth != depth_ ? kUnasked : entry.sign;
}

void PairMemory::keep_sign(LineId line, PointId point, int sign) {
  entries_[slot(line, point)] = {key(line, point), way_.back(), static_cast<std::int8_t>(sign)};
}

const std::shared_ptr<const Plane>& PairMemory::plane(const Points& points, LineId line, PointId point) {
  const std::tuple place(pair_, line, point);
  if (const auto known = planes_.find(place); known != planes_.end()) return known->second;
  if (planes_.size() >= kMostPlanes) planes_.clear();
  const Line& ends = points.line(line);
  Plane made = make_plane(join(points[ends.a], points[ends.b], points[point]), points.units());
  return planes_.emplace(place, std::make_shared<const Plane>(std::move(made))).first->second;
}

}  // namespace exactff::view_factors
