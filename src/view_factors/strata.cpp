#include "view_factors/strata.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

constexpr int kWeightBits = 32;

// SplitMix64's mixing (models/random.h) of a key: numbers that depend on the key alone.
std::uint64_t mixed(std::uint64_t key) {
  std::uint64_t z = (key + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

void cut_triangle(std::size_t part, std::size_t second, double area, double largest, std::vector<SmallTriangle>& into) {
  const auto m = static_cast<std::uint32_t>(std::ceil(std::sqrt(area / largest)));
  const double small = area / (static_cast<double>(m) * m);
  for (std::uint32_t u = 0; u < m; ++u) {
    for (std::uint32_t v = 0; u + v < m; ++v) {
      into.push_back({part, second, m, u, v, false, small});
      if (u + v + 1 < m) into.push_back({part, second, m, u, v, true, small});
    }
  }
}

// The point of a part with these weights, in units of 1 / (m 2^kWeightBits), at the corners of a fan's triangle.
Point weighted(const Part& part, const SmallTriangle& triangle, const std::array<Integer, 3>& weights,
               const Units& units) {
  const std::array<const Point*, 3> corners{&part.corners[0], &part.corners[triangle.second],
                                            &part.corners[triangle.second + 1]};
  Homogeneous sum;
  for (std::size_t i = 0; i < 3; ++i) {
    const Integer factor = weights[i] * corners[(i + 1) % 3]->exact[3] * corners[(i + 2) % 3]->exact[3];
    for (std::size_t k = 0; k < 3; ++k) sum[k] += factor * corners[i]->exact[k];
    sum[3] += factor * corners[i]->exact[3];
  }
  return make_point(std::move(sum), units);
}

}  // namespace

Draws::Draws(std::size_t look, std::size_t stratum, std::size_t number)
    : key_(mixed(mixed(look) ^ mixed(stratum) << 1 ^ number)) {}
std::uint64_t Draws::bits() { return mixed(key_ ^ ++count_ << 32); }
double Draws::unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

Strata strata_of(const std::vector<Part>& parts, std::size_t count) {
  Strata result;
  const double largest = area_of(parts) / static_cast<double>(count);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<Vec3> ring = rounded(parts[p].corners);
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      if (const double size = area({ring[0], ring[i], ring[i + 1]}); size > 0.0) {
        cut_triangle(p, i, size, largest, result.triangles);
      }
    }
  }
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const double size = result.triangles[i].area;
    const bool joins = !result.strata.empty() && result.strata.back().area + size <= largest;
    if (!joins) result.strata.push_back({i, i, 0.0});
    result.strata.back().end = i + 1;
    result.strata.back().area += size;
  }
  for (const Stratum& stratum : result.strata) result.area += stratum.area;
  for (const Stratum& stratum : result.strata) {
    const double share = stratum.area / result.area;
    result.squares_of_shares += share * share;
  }
  return result;
}

const SmallTriangle& drawn(const Strata& strata, const Stratum& stratum, Draws& draws) {
  std::size_t i = stratum.begin;
  for (double left = draws.unit() * stratum.area; i + 1 < stratum.end && left >= strata.triangles[i].area; ++i) {
    left -= strata.triangles[i].area;
  }
  return strata.triangles[i];
}

std::array<Point, 3> triple_in(const Part& part, const SmallTriangle& triangle, Draws& draws, const Units& units) {
  constexpr std::uint64_t kWhole = std::uint64_t{1} << kWeightBits;
  std::uint64_t a = draws.bits() >> (64 - kWeightBits), b = draws.bits() >> (64 - kWeightBits);
  if (a + b > kWhole) {
    a = kWhole - a;
    b = kWhole - b;
  }
  const std::array<std::uint64_t, 3> drawn{a, b, kWhole - a - b};
  // The small triangle's corners in units of an m-th.
  const std::uint64_t u = triangle.u, v = triangle.v, turned = triangle.turned ? 1 : 0;
  const std::array<std::uint64_t, 3> us{u + turned, u + 1 - turned, u + turned},
      vs{v + turned, v + turned, v + 1 - turned};
  std::array<Point, 3> points;
  for (std::size_t turn = 0; turn < 3; ++turn) {
    Integer along = 0, across = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      along += Integer(us[i]) * Integer(drawn[(i + turn) % 3]);
      across += Integer(vs[i]) * Integer(drawn[(i + turn) % 3]);
    }
    const Integer whole = Integer(triangle.m) << kWeightBits;
    points[turn] = weighted(part, triangle, {whole - along - across, along, across}, units);
  }
  return points;
}

void StratifiedMean::add(double a, double b, double share) {
  const double half = 0.5 * (a - b) * share, square = half * half;
  value += 0.5 * (a + b) * share;
  variance += square;
  of_variance += square * square;
}

double StratifiedMean::error(double risk, double points, const Strata& strata) const {
  if (!(of_variance > 0.0)) return std::min(1.0, -std::log(risk) / points);
  const double freedom = std::max(1.0, variance * variance / of_variance);
  const boost::math::students_t_distribution<double> student(freedom);
  const double t = boost::math::quantile(boost::math::complement(student, 0.25 * risk));
  const double hoeffding = 0.5 * std::sqrt(std::log(4.0 / risk) * strata.squares_of_shares);
  return std::min({1.0, t * std::sqrt(variance), hoeffding});
}

}  // namespace exactff::view_factors
