#include "view_factors/certified_integral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/gauss.h"
#include "view_factors/disc_formula.h"

namespace exactff::view_factors {
namespace {

using kernel::kMostNodes;
using kernel::disc::kUp;

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

CertifiedIntegral certified_integral(const Formula& formula, const Cell& cell, double tolerance) {
  const double area = magnitude(enclosed_area(cell, formula.receiver()));
  const CertifiedIntegral unknown{0.5 * area, 0.5 * area, false};
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
