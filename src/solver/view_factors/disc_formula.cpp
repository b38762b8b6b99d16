#include "view_factors/disc_formula.h"

#include <cmath>

namespace exactff::view_factors {
namespace {

constexpr double kSmallestDouble = 0x1p-900;  // of those that are certainly not rounded by an underflow
constexpr long kMantissaBits = 53;
constexpr double kSteep = 0.25;  // the sine between a line and the receiver's normal, below which another frame is used

Disc enclose(const Integer& numerator, const Integer& denominator, double rounded) {
  if (denominator == 1) {
    if (sgn(numerator) == 0) return {};
    const auto zeros = static_cast<long>(mpz_scan1(numerator.get_mpz_t(), 0));
    const bool is_double = kernel::bit_length(numerator) - zeros <= kMantissaBits;
    if (is_double && std::abs(rounded) >= kSmallestDouble) return {rounded, 0.0};
  }
  return kernel::rounded_once(rounded);
}

bool may_be_zero(const Disc& a) { return !(std::abs(a.centre) > a.radius); }

// The line through the two points is perpendicular to the plane.
bool is_along(const Plane& plane, const Point& a, const Point& b) {
  std::array<Integer, 3> d;
  for (std::size_t i = 0; i < 3; ++i) d[i] = b.exact[i] * a.exact[3] - a.exact[i] * b.exact[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (d[i] * plane.exact[j] != d[j] * plane.exact[i]) return false;
  }
  return true;
}

// A direction that is far from parallel to a unit vector: the receiver's normal, or an axis.
DiscVec aside_of(const DiscVec& unit_vector, const DiscVec& normal) {
  const DiscVec product = cross(unit_vector, normal);
  if (squared_length(product).centre >= kSteep * kSteep) return normal;
  const double x = std::abs(unit_vector.x.centre), y = std::abs(unit_vector.y.centre);
  const double z = std::abs(unit_vector.z.centre);
  if (x <= y && x <= z) return {{1.0, 0.0}, {}, {}};
  return y <= z ? DiscVec{{}, {1.0, 0.0}, {}} : DiscVec{{}, {}, {1.0, 0.0}};
}

}  // namespace

DiscVec enclose(const Point& point) {
  return {enclose(point.exact[0], point.exact[3], point.at.x), enclose(point.exact[1], point.exact[3], point.at.y),
          enclose(point.exact[2], point.exact[3], point.at.z)};
}

DiscVec unit_normal(const Plane& plane) {
  return unit({kernel::rounded_once(plane.rounded[0]), kernel::rounded_once(plane.rounded[1]),
               kernel::rounded_once(plane.rounded[2])});
}

DiscFormula::DiscFormula(const Formula& formula, const Cell& cell)
    : origin_(enclose(cell.corners[0])), normal_(unit_normal(formula.receiver())) {
  sum_.constant = formula.constant();
  DiscVec sum;
  for (const Point& corner : cell.corners) {
    corners_.push_back(enclose(corner) - origin_);
    sum = sum + corners_.back();
  }
  const DiscVec middle = sum * kernel::rounded_once(1.0 / static_cast<double>(cell.corners.size()));
  for (std::size_t i = 0; i < formula.boundary().size(); ++i) add(formula, i);
  for (DiscTerm& term : sum_.terms) {
    const Disc nu = dot(term.height.from - middle, term.height.gradient);
    term.side = is_positive(nu) ? 1.0 : is_negative(nu) ? -1.0 : 0.0;
  }
  if (corners_.size() < 3) take({0, 0, 0, 0});
}

DiscVec DiscFormula::place(const Formula& formula, PointId id) const { return enclose(formula.points()[id]) - origin_; }

void DiscFormula::add(const Formula& formula, std::size_t index) {
  const BoundaryPart& boundary = formula.boundary()[index];
  const Point &first = formula.points()[boundary.edge.from], &second = formula.points()[boundary.edge.to];
  const DiscVec a = enclose(first) - origin_, edge = enclose(second) - enclose(first);
  const Disc size = square_root(squared_length(edge));
  const DiscVec along = edge * inverse(size), height = cross(along, normal_);
  const bool may_be_along = may_be_zero(height.x) && may_be_zero(height.y) && may_be_zero(height.z);
  if (may_be_along && is_along(formula.receiver(), first, second)) return;  // nu = 0
  const DiscVec across = unit(cross(along, aside_of(along, normal_)));
  // (A - x) x l . n = (A - x) . (l x n)
  sum_.terms.push_back({.along = {a, along, {}},
                        .across = {a, across, {}},
                        .beyond = {a, cross(along, across), {}},
                        .height = {a, height, {}},
                        .size = size,
                        .from = end_of(formula, boundary, boundary.from),
                        .to = end_of(formula, boundary, boundary.to),
                        .in_receiver_plane = formula.is_in_receiver_plane(index),
                        .sign = static_cast<double>(boundary.sign)});
}

DiscTerm::End DiscFormula::end_of(const Formula& formula, const BoundaryPart& part, const End& end) const {
  if (!end.line) return {false, end.vertex == part.edge.from ? 0.0 : 1.0, {}, {}};
  const Line& line = formula.points().line(*end.line);
  const DiscVec c = place(formula, line.a), e = place(formula, line.b) - c;
  const DiscVec a = place(formula, part.edge.from), edge = place(formula, part.edge.to) - a;
  return {true, 0.0, {c, cross(e, a - c), {}}, {c, cross(edge, e), {}}};
}

void DiscFormula::take(const std::array<std::size_t, 4>& corners) {
  const DiscVec &q = corners_[corners[1]], &v = corners_[corners[2]];
  SquareMap map{.a = q, .b = {}, .c = v - q};
  if (corners[2] != corners[3]) {
    map.b = corners_[corners[3]];
    map.c = map.c - map.b;
  }
  view_factors::take(sum_, map, normal_);
}

}  // namespace exactff::view_factors
