#include "view_factors/certified_integral.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kernel/gauss.h"

namespace exactff::view_factors {

using kernel::kMostNodes;
using kernel::disc::kUp;

// --- Disc formula ---

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

// --- Certified integral ---

namespace {

constexpr std::array<double, 6> kEllipses = {5.0, 3.75, 2.75, 2.125, 1.625, 1.375};  // rho
constexpr std::size_t kMostNodesOfPiece = 144;  // of a quadrilateral: beyond, two halves are cheaper
constexpr double kFinalShare = 0.5;             // of an error that is called final

struct Rule {
  std::size_t nodes = 0;
  double remainder = 0.0;
};

// The fewest nodes whose remainder is within the tolerance.
std::optional<Rule> rule_for(const DiscFormula& formula, Axis axis, double tolerance) {
  for (const double rho : kEllipses) {
    const double bound = bound_on_ellipse(formula, axis, rho);
    if (!(bound < HUGE_VAL)) continue;
    for (std::size_t nodes = 2; nodes <= kMostNodes; ++nodes) {
      const double error = quadrature_remainder(bound, rho, nodes);
      if (error <= tolerance) return Rule{nodes, error};
    }
  }
  return std::nullopt;
}

// Requires at most kMostNodesOfPiece nodes. Four at a time; the last one is repeated if there are fewer.
Disc gauss_sum(const DiscFormula& formula, std::size_t nodes_s, std::size_t nodes_t) {
  const auto& in_s = kernel::enclosed_gauss_rule(nodes_s);
  const auto& in_t = kernel::enclosed_gauss_rule(nodes_t);
  const std::size_t count = nodes_s * nodes_t;
  std::array<Disc, kMostNodesOfPiece> integrands;
  for (std::size_t first = 0; first < count; first += 4) {
    FourDiscs s, t;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::size_t i = std::min(first + lane, count - 1);
      s[lane] = in_s[i / nodes_t].at;
      t[lane] = in_t[i % nodes_t].at;
    }
    const FourDiscs found = formula.integrands(s, t);
    std::copy_n(found.begin(), std::min<std::size_t>(4, count - first), integrands.begin() + first);
  }
  Disc sum;
  for (std::size_t i = 0; i < nodes_s; ++i) {
    Disc row;
    for (std::size_t j = 0; j < nodes_t; ++j) row = row + in_t[j].weight * integrands[i * nodes_t + j];
    sum = sum + in_s[i].weight * row;
  }
  return sum;
}

// The quadrilaterals of a cell, as corners.
std::vector<std::array<std::size_t, 4>> quadrilaterals(std::size_t corners) {
  std::vector<std::array<std::size_t, 4>> result;
  for (std::size_t i = 1; i + 1 < corners; i += 2) result.push_back({0, i, i + 1, std::min(i + 2, corners - 1)});
  return result;
}

}  // namespace

// Roundings, of the centre too, are less than kUp adds to the radius.
Disc cover_of_half_ellipse(double rho) {
  const double a = 0.5 * (rho + 1.0 / rho), b = 0.5 * (rho - 1.0 / rho), centre = 0.5 / a;
  return {centre, std::sqrt(b * b + centre * centre) * kUp * kUp};
}

double bound_on_ellipse(const DiscFormula& formula, Axis axis, double rho) {
  const auto [centre, radius] = cover_of_half_ellipse(rho);
  FourDiscs complex, real;  // each half of the ellipse with each half of [0, 1]
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = i < 2 ? -1.0 : 1.0, range = i % 2 == 0 ? 0.25 : 0.75;
    complex[i] = {0.5 + 0.5 * side * centre, 0.5 * radius * kUp};
    real[i] = {range, 0.25};
  }
  double largest = 0.0;
  for (const Disc& g : axis == Axis::kS ? formula.integrands(complex, real) : formula.integrands(real, complex)) {
    const double bound = magnitude(g);
    if (!(bound < HUGE_VAL)) return HUGE_VAL;
    largest = std::max(largest, bound);
  }
  return largest;
}

// Half of what it is on [-1, 1].
double quadrature_remainder(double bound, double rho, std::size_t nodes) {
  const double inverse_square = 1.0 / (rho * rho);
  double power = 1.0;
  for (std::size_t i = 0; i < nodes; ++i) power *= inverse_square * kUp;
  return 0.5 * 64.0 / 15.0 * bound * power / (1.0 - inverse_square) * kUp;
}

Disc enclosed_area(const Cell& cell, const Plane& receiver) {
  const DiscVec origin = enclose(cell.corners[0]);
  DiscVec sum;
  for (std::size_t i = 2; i < cell.corners.size(); ++i) {
    sum = sum + cross(enclose(cell.corners[i - 1]) - origin, enclose(cell.corners[i]) - origin);
  }
  return 0.5 * dot(sum, unit_normal(receiver));
}

CertifiedIntegral certified_integral(const Formula& formula, const Cell& cell, double most, double tolerance) {
  const double half = 0.5 * most * magnitude(enclosed_area(cell, formula.receiver())) * kUp;
  const CertifiedIntegral unknown{half, half, false};
  DiscFormula on_cell(formula, cell);
  const auto pieces = quadrilaterals(cell.corners.size());
  const double allowed = 0.5 * tolerance / static_cast<double>(pieces.size());
  Disc sum;
  double remainders = 0.0;
  for (const auto& corners : pieces) {
    on_cell.take(corners);
    const std::optional<Rule> s = rule_for(on_cell, Axis::kS, allowed);
    if (!s) return unknown;
    const std::optional<Rule> t = rule_for(on_cell, Axis::kT, allowed);
    if (!t || s->nodes * t->nodes > kMostNodesOfPiece) return unknown;
    remainders = (remainders + s->remainder + t->remainder) * kUp;
    sum = sum + gauss_sum(on_cell, s->nodes, t->nodes);
  }
  const double error = (sum.radius + remainders) * kUp;
  if (!(error < unknown.error)) return unknown;
  return {sum.centre, error, sum.radius > kFinalShare * error};
}

}  // namespace exactff::view_factors
