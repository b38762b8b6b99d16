#include "view_factors/exact_scene.h"

#include <algorithm>
#include <cmath>

#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/scene.h"

namespace exactff::view_factors {

// --- Exact space ---

namespace {

constexpr double kSubtractionError = 0x1p-51;  // of a component of a difference of two points, each rounded once
constexpr int kExactBits = 50;                 // of products whose sums of four are exact
constexpr int kBitsForRoundedPlane = 15;       // see RoundedPlane
constexpr long kLargestShift = 256;            // so that no product of three numbers underflows

int bits_of(std::span<const Integer> numbers, const Units& units) {
  if (units.shift > kLargestShift) return kManyBits;
  long bits = 0;
  for (const Integer& x : numbers) bits = std::max(bits, kernel::bit_length(x));
  return static_cast<int>(std::min<long>(bits, kManyBits));
}

Integer integer_of(double value, const Units& units) {
  const kernel::BinaryDouble parts = kernel::decompose(value);
  Integer result(parts.mantissa);
  if (parts.mantissa != 0) result <<= static_cast<unsigned long>(parts.exponent - units.exponent);
  return result;
}

Integer minor(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c, int i, int j, int k) {
  return a[i] * (b[j] * c[k] - b[k] * c[j]) - a[j] * (b[i] * c[k] - b[k] * c[i]) + a[k] * (b[i] * c[j] - b[j] * c[i]);
}

// The vector that is orthogonal to three others, with the sign of a determinant.
Homogeneous orthogonal(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c) {
  return {minor(a, b, c, 1, 2, 3), -minor(a, b, c, 0, 2, 3), minor(a, b, c, 0, 1, 3), -minor(a, b, c, 0, 1, 2)};
}

// Divides by the greatest common divisor.
void make_primitive(Homogeneous& a) {
  Integer divisor = abs(a[0]);
  for (int i = 1; i < 4; ++i) divisor = gcd(divisor, a[i]);
  if (divisor <= 1) return;
  for (Integer& x : a) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
}

}  // namespace

Units Units::of(std::span<const Vec3> vertices) {
  int least = std::numeric_limits<int>::max();
  double largest = 0.0;
  for (const Vec3& v : vertices) {
    for (const double x : {v.x, v.y, v.z}) {
      if (x != 0.0) least = std::min(least, kernel::decompose(x).exponent);
    }
    largest = std::max(largest, kernel::max_norm(v));
  }
  if (largest == 0.0) return {};
  return {least, std::ilogb(largest) + 1 - least};
}

Point point_of(const Vec3& v, const Units& units) {
  return make_point({integer_of(v.x, units), integer_of(v.y, units), integer_of(v.z, units), Integer(1)}, units);
}

Point make_point(Homogeneous exact, const Units& units) {
  EXACTFF_EXPECT(sgn(exact[3]) != 0);
  if (sgn(exact[3]) < 0) exact = opposite(std::move(exact));
  make_primitive(exact);
  const auto coordinate = [&](int i) {
    return exact[3] == 1 ? kernel::nearest_double(exact[i], -units.shift)
                         : kernel::nearest_double(exact[i], exact[3], -units.shift);
  };
  const Vec3 at{coordinate(0), coordinate(1), coordinate(2)};
  const int bits = exact[3] == 1 ? bits_of(std::span(exact).first(3), units) : kManyBits;
  return {std::move(exact), at, bits};
}

Plane make_plane(Homogeneous exact, const Units& units) {
  make_primitive(exact);
  long bits = kernel::bit_length(exact[3]) - units.shift;
  for (int i = 0; i < 3; ++i) bits = std::max(bits, kernel::bit_length(exact[i]));
  Plane plane{std::move(exact), {}, kManyBits};
  plane.bits = bits_of(plane.exact, units);
  for (int i = 0; i < 4; ++i) {
    plane.rounded[i] = kernel::nearest_double(plane.exact[i], -bits - (i == 3 ? units.shift : 0));
  }
  return plane;
}

Side Side::of(const Plane& plane) {
  const auto& n = plane.rounded;
  const double size = std::hypot(n[0], n[1], n[2]);
  return {{n[0] / size, n[1] / size, n[2] / size}, n[3] / size};
}

Homogeneous join(const Point& a, const Point& b, const Point& c) { return orthogonal(a.exact, b.exact, c.exact); }
Homogeneous meet(const Plane& a, const Plane& b, const Plane& c) { return orthogonal(a.exact, b.exact, c.exact); }

bool is_zero(const Homogeneous& a) {
  return std::ranges::all_of(a, [](const Integer& x) { return sgn(x) == 0; });
}

Homogeneous opposite(Homogeneous a) {
  for (Integer& x : a) mpz_neg(x.get_mpz_t(), x.get_mpz_t());
  return a;
}

int side_of(const Plane& plane, const Point& point) {
  const double terms[] = {plane.rounded[0] * point.at.x, plane.rounded[1] * point.at.y, plane.rounded[2] * point.at.z,
                          plane.rounded[3]};
  const double sum = terms[0] + terms[1] + terms[2] + terms[3];
  if (plane.bits + point.bits <= kExactBits) return sum > 0.0 ? 1 : sum < 0.0 ? -1 : 0;
  const double magnitude = std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]) + std::abs(terms[3]);
  const int filtered = kernel::certified_sign(sum, magnitude);
  if (filtered != kernel::kUncertain) return filtered;
  Integer value = plane.exact[3] * point.exact[3];
  for (int i = 0; i < 3; ++i) value += plane.exact[i] * point.exact[i];
  return sgn(value);
}

RoundedPlane::RoundedPlane(const Point& a, const Point& b, const Point& c)
    : origin_(a.at), is_exact_(std::max({a.bits, b.bits, c.bits}) <= kBitsForRoundedPlane) {
  const Vec3 ab = kernel::difference(b.at, a.at), ac = kernel::difference(c.at, a.at);
  normal_ = kernel::cross(ab, ac);
  const double size_b = kernel::max_norm(ab) + kSubtractionError, size_c = kernel::max_norm(ac) + kSubtractionError;
  product_ = size_b * size_c;
  sum_ = size_b + size_c;
}

double RoundedPlane::height(const Vec3& x) const { return kernel::dot(normal_, kernel::difference(x, origin_)); }

double RoundedPlane::error_at(const Vec3& from_origin) const {
  return 0x1p-46 * (product_ + sum_ * (kernel::max_norm(from_origin) + kSubtractionError));
}

int RoundedPlane::side_of(const Point& x) const {
  const Vec3 ax = kernel::difference(x.at, origin_);
  const double value = kernel::dot(normal_, ax);
  if (is_exact_ && x.bits <= kBitsForRoundedPlane) return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
  const double error = error_at(ax);
  return value > error ? 1 : value < -error ? -1 : kernel::kUncertain;
}

bool RoundedPlane::is_beyond(const Vec3& x, double errors) const {
  const Vec3 ax = kernel::difference(x, origin_);
  return std::abs(kernel::dot(normal_, ax)) > errors * error_at(ax);
}

// --- Exact scene ---

namespace {

// Without corners that lie between their neighbours on a line.
std::vector<std::uint32_t> true_corners(std::vector<std::uint32_t> corners, const std::vector<Point>& points) {
  for (std::size_t i = 0; i < corners.size() && corners.size() > 2;) {
    const std::size_t count = corners.size();
    const Point& before = points[corners[(i + count - 1) % count]];
    const Point& after = points[corners[(i + 1) % count]];
    if (is_zero(join(before, points[corners[i]], after))) {
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
      i = i == 0 ? 0 : i - 1;
    } else {
      ++i;
    }
  }
  return corners;
}

}  // namespace

void Box::include(const Vec3& v) {
  low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
  high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
}

bool Box::is_apart_from(const Box& other) const {
  constexpr double kGap = 0x1p-50;  // no coordinate exceeds 1
  const auto apart = [](double high_end, double low_end) { return high_end + kGap < low_end; };
  return apart(high.x, other.low.x) || apart(high.y, other.low.y) || apart(high.z, other.low.z) ||
         apart(other.high.x, low.x) || apart(other.high.y, low.y) || apart(other.high.z, low.z);
}

double gap(const Box& a, const Box& b) {
  const auto along = [](double low_a, double high_a, double low_b, double high_b) {
    return std::max({0.0, low_a - high_b, low_b - high_a});
  };
  return std::hypot(along(a.low.x, a.high.x, b.low.x, b.high.x), along(a.low.y, a.high.y, b.low.y, b.high.y),
                    along(a.low.z, a.high.z, b.low.z, b.high.z));
}

Box box_of(std::span<const Point> points) {
  Box box;
  for (const Point& point : points) box.include(point.at);
  return box;
}

ExactScene::ExactScene(const Scene& scene_in)
    : scene(scene_in), units(Units::of(scene_in.vertices())), vertices(scene_in.vertices().size()) {
  const Panels& panels = exactff::panels(scene);
  pieces.reserve(scene.pieces().size());
  for (PanelId id = 0; id < panels.end(); ++id) {
    kernel::poll();
    ExactPiece made = exact_piece(panels.piece(id), panels.corners(id));
    if (panels.is_joined(id)) {
      const std::uint32_t surface = panels.sheet_of(id).surface;
      made.surface = surface == ClosedSurfaces::kNone ? kNoSurface : surface;
    }
    (panels.is_joined(id) ? joined : pieces).push_back(std::move(made));
  }
  const ClosedSurfaces& closed = closed_surfaces(scene);
  surfaces = exact_surfaces(closed, pieces, units);
  if (closed.empty()) return;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const std::uint32_t surface = closed.of_piece(i);
    if (surface != ClosedSurfaces::kNone) pieces[i].surface = surface;
  }
}

ExactPiece ExactScene::exact_piece(const Piece& piece, std::span<const std::uint32_t> corners) {
  const auto place_of = places(scene);
  ExactPiece made{piece.face, piece.transparent, kNoSurface, {}, {}, {}};
  for (const std::uint32_t corner : corners) {
    const std::uint32_t place = place_of[corner];
    if (sgn(vertices[place].exact[3]) == 0) vertices[place] = point_of(scene.vertices()[place], units);
    made.corners.push_back(place);
    made.box.include(vertices[place].at);
  }
  made.corners = true_corners(std::move(made.corners), vertices);
  made.plane = make_plane(join(vertices[made.corners[0]], vertices[made.corners[1]], vertices[made.corners[2]]), units);
  return made;
}

std::vector<ExactSurface> exact_surfaces(const ClosedSurfaces& closed, std::span<const ExactPiece> pieces,
                                         const Units& units) {
  std::vector<ExactSurface> surfaces;
  if (closed.empty()) return surfaces;
  for (const ClosedSurface& surface : closed.surfaces()) {
    surfaces.push_back({{}, surface.turned_inside_out, {}, {}});
    if (!surface.rim) continue;
    const auto& [a, b, c] = surface.rim->plane;
    surfaces.back().rim = make_plane(join(point_of(a, units), point_of(b, units), point_of(c, units)), units);
  }
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const std::uint32_t surface = closed.of_piece(i);
    if (surface == ClosedSurfaces::kNone) continue;
    surfaces[surface].pieces.push_back(i);
    surfaces[surface].box.include(pieces[i].box.low);
    surfaces[surface].box.include(pieces[i].box.high);
  }
  return surfaces;
}

// --- Polygons ---

PointId Points::add(Point point) {
  own_.push_back(std::move(point));
  return refer_to(own_.back());
}

PointId Points::refer_to(const Point& point) {
  points_.push_back(&point);
  return static_cast<PointId>(points_.size() - 1);
}

Edge Points::edge(PointId from, PointId to) {
  const auto [place, is_new] = line_of_.try_emplace(std::minmax(from, to), static_cast<LineId>(lines_.size()));
  if (is_new) lines_.push_back({from, to});
  return {from, to, place->second, lines_[place->second].a == from};
}

Ring Points::ring(const std::vector<PointId>& corners) {
  Ring result;
  for (std::size_t i = 0; i < corners.size(); ++i)
    result.push_back(edge(corners[i], corners[(i + 1) % corners.size()]));
  return result;
}

std::vector<Vec3> Points::positions(const Ring& ring) const {
  std::vector<Vec3> result;
  for (const Edge& edge : ring) result.push_back((*this)[edge.from].at);
  return result;
}

PointId Points::crossing(const Edge& edge, const Plane& plane, std::uint32_t name) {
  const auto [place, is_new] = crossing_of_.try_emplace({edge.line, name}, static_cast<PointId>(points_.size()));
  if (is_new) {
    const auto height = [&](PointId id) {
      Integer sum;
      for (std::size_t i = 0; i < 4; ++i) sum += plane.exact[i] * points_[id]->exact[i];
      return sum;
    };
    const Line& line = lines_[edge.line];
    const Integer a = height(line.a), b = height(line.b);
    Homogeneous point;
    for (std::size_t i = 0; i < 4; ++i) point[i] = points_[line.a]->exact[i] * b - points_[line.b]->exact[i] * a;
    add(make_point(std::move(point), units_));
  }
  return place->second;
}

Edge Points::between_crossings(const Edge& one, const Edge& other, const Plane& plane, std::uint32_t name) {
  const PointId from = crossing(one, plane, name);
  return edge(from, crossing(other, plane, name));
}

Ring Points::clip(const Ring& ring, const Plane& plane, std::uint32_t name) {
  std::vector<int> sides;
  for (const Edge& e : ring) sides.push_back(side_of(plane, *points_[e.from]));
  if (std::ranges::all_of(sides, [](int s) { return s >= 0; })) {
    return std::ranges::any_of(sides, [](int s) { return s > 0; }) ? ring : Ring{};
  }
  if (std::ranges::all_of(sides, [](int s) { return s <= 0; })) return {};
  // What stays of every edge, in order. One gap is left, along the plane.
  Ring result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const int from = sides[i], to = sides[(i + 1) % ring.size()];
    if (from <= 0 && to <= 0) continue;
    Edge kept = ring[i];
    if (from < 0) kept.from = crossing(ring[i], plane, name);
    if (to < 0) kept.to = crossing(ring[i], plane, name);
    result.push_back(kept);
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Edge& next = result[(i + 1) % result.size()];
    if (result[i].to == next.from) continue;
    result.insert(result.begin() + static_cast<std::ptrdiff_t>(i) + 1, edge(result[i].to, next.from));
    break;
  }
  return result;
}

void Points::complete() {
  line_of_.clear();
  crossing_of_.clear();
  points_.shrink_to_fit();
  lines_.shrink_to_fit();
}

}  // namespace exactff::view_factors
