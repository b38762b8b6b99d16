#include "view_factors/disc_formula.h"

#include <cmath>

namespace exactff::view_factors {
namespace {

using kernel::kInversePi;

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
    : origin_(enclose(cell.corners[0])), normal_(unit_normal(formula.receiver())), constant_(formula.constant()) {
  DiscVec sum;
  for (const Point& corner : cell.corners) {
    corners_.push_back(enclose(corner) - origin_);
    sum = sum + corners_.back();
  }
  const DiscVec middle = sum * kernel::rounded_once(1.0 / static_cast<double>(cell.corners.size()));
  for (std::size_t i = 0; i < formula.boundary().size(); ++i) add(formula, i);
  for (Part& part : parts_) {
    const Disc nu = dot(part.height.from - middle, part.height.gradient);
    part.side = is_positive(nu) ? 1.0 : is_negative(nu) ? -1.0 : 0.0;
  }
  if (corners_.size() < 3) take({0, 0, 0, 0});
}

DiscVec DiscFormula::place(const Formula& formula, PointId id) const { return enclose(formula.points()[id]) - origin_; }

void DiscFormula::add(const Formula& formula, std::size_t index) {
  const BoundaryPart& boundary = formula.boundary()[index];
  const Point &first = formula.points()[boundary.edge.from], &second = formula.points()[boundary.edge.to];
  const DiscVec a = enclose(first) - origin_, edge = enclose(second) - enclose(first);
  Part part;
  part.size = square_root(squared_length(edge));
  const DiscVec along = edge * inverse(part.size), height = cross(along, normal_);
  const bool may_be_along = may_be_zero(height.x) && may_be_zero(height.y) && may_be_zero(height.z);
  if (may_be_along && is_along(formula.receiver(), first, second)) return;  // nu = 0
  const DiscVec across = unit(cross(along, aside_of(along, normal_)));
  part.along = {a, along};
  part.across = {a, across};
  part.beyond = {a, cross(along, across)};
  // (A - x) x l . n = (A - x) . (l x n)
  part.height = {a, height};
  part.from = ending(formula, boundary, boundary.from);
  part.to = ending(formula, boundary, boundary.to);
  part.in_receiver_plane = formula.is_in_receiver_plane(index);
  part.sign = boundary.sign;
  parts_.push_back(part);
}

DiscFormula::Ending DiscFormula::ending(const Formula& formula, const BoundaryPart& part, const End& end) {
  if (!end.line) return {-1, end.vertex == part.edge.from ? 0.0 : 1.0};
  const Line& line = formula.points().line(*end.line);
  const DiscVec c = place(formula, line.a), e = place(formula, line.b) - c;
  const DiscVec a = place(formula, part.edge.from), edge = place(formula, part.edge.to) - a;
  crossings_.push_back({{c, cross(e, a - c)}, {c, cross(edge, e)}, {}, {}});
  return {static_cast<int>(crossings_.size()) - 1, 0.0};
}

Bilinear DiscFormula::on_square(const Vectors& f) const {
  return {{dot(f.from, f.gradient), -dot(a_, f.gradient), -dot(b_, f.gradient), -dot(c_, f.gradient)}};
}

void DiscFormula::take(const std::array<std::size_t, 4>& corners) {
  const DiscVec &q = corners_[corners[1]], &v = corners_[corners[2]];
  a_ = q;
  b_ = {};
  c_ = v - q;
  if (corners[2] != corners[3]) {
    b_ = corners_[corners[3]];
    c_ = c_ - b_;
  }
  jacobian_ = {{dot(normal_, cross(a_, b_)), dot(normal_, cross(a_, c_)), dot(normal_, cross(c_, b_)), {}}};
  for (Part& part : parts_) {
    part.along_on = on_square(part.along);
    part.across_on = on_square(part.across);
    part.beyond_on = on_square(part.beyond);
    part.height_on = on_square(part.height);
  }
  for (Crossing& crossing : crossings_) {
    crossing.above_on = on_square(crossing.above);
    crossing.below_on = on_square(crossing.below);
  }
}

Disc DiscFormula::fraction_of(const Ending& end, const Disc& s, const Disc& t) const {
  if (end.crossing < 0) return {end.fraction, 0.0};
  const Crossing& crossing = crossings_[static_cast<std::size_t>(end.crossing)];
  return crossing.above_on.at(s, t) / crossing.below_on.at(s, t);
}

// T of the header.
Disc DiscFormula::term(const Part& part, const Disc& s, const Disc& t) const {
  const Disc along = part.along_on.at(s, t), nu = part.height_on.at(s, t);
  const Disc squared = square(part.across_on.at(s, t)) + square(part.beyond_on.at(s, t));  // d^2
  const Disc from = fraction_of(part.from, s, t), to = fraction_of(part.to, s, t);
  const Disc p = along + part.size * from, q = along + part.size * to;  // their components along l
  Disc between = part.size * (to - from);                               // D
  const Disc product = p * q + squared;                                 // p.q
  const Disc roots = square_root(square(p) + squared) * square_root(square(q) + squared);
  if (product.centre > 0.0) {
    const Disc w = between / (roots + product);
    return nu * w * atan_of_root(square(w) * squared) * kInversePi;
  }
  double orientation = 1.0;  // negative if P and Q have changed places: T is odd
  if (is_negative(between)) {
    between = -between;
    orientation = -1.0;
  } else if (!is_positive(between)) {
    return kernel::disc::kFailed;
  }
  const Disc w = between / (roots - product);
  Disc half = 0.5 * (nu / square_root(squared));
  if (part.in_receiver_plane) half = part.side != 0.0 ? Disc{0.5 * part.side, 0.0} : kernel::disc::kFailed;
  return orientation * (half - nu * w * atan_of_root(square(w) * squared) * kInversePi);
}

Disc DiscFormula::value(const Disc& s, const Disc& t) const {
  Disc sum{constant_, 0.0};
  for (const Part& part : parts_) {
    const Disc one = term(part, s, t);
    if (!is_finite(one)) return kernel::disc::kFailed;
    sum = part.sign > 0.0 ? sum - one : sum + one;
  }
  return sum;
}

}  // namespace exactff::view_factors
