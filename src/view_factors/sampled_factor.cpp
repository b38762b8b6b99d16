#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "view_factors/near_planes.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kFirstStrata = 36;
constexpr std::size_t kTriples = 2;  // of a stratum
constexpr std::size_t kPointsOfStratum = 3 * kTriples;
constexpr int kWeightBits = 32;

// SplitMix64's mixing (models/random.h) of a key: numbers that depend on the key alone.
std::uint64_t mixed(std::uint64_t key) {
  std::uint64_t z = (key + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

// Draws of one triple.
class Draws {
 public:
  Draws(std::size_t look, std::size_t stratum, std::size_t triple)
      : key_(mixed(mixed(look) ^ mixed(stratum) << 1 ^ triple)) {}
  std::uint64_t bits() { return mixed(key_ ^ ++count_ << 32); }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

// One of the m^2 triangles into which a triangle of a part's fan is cut: with corners (u, v) + (0, 0), (1, 0), (0, 1),
// or (1, 1), (0, 1), (1, 0), in units of an m-th of its sides from its first corner.
struct SmallTriangle {
  std::size_t part, second;  // the fan's triangle has the corners 0, second, second + 1
  std::uint32_t m, u, v;
  bool turned;
  double area;
};

struct Stratum {
  std::size_t begin, end;  // small triangles
  double area;
};

struct Strata {
  std::vector<SmallTriangle> triangles;
  std::vector<Stratum> strata;
};

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

// Small triangles in a row share a stratum until it has an area of total / count.
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
  return result;
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

// The three points of a triple.
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

// F at exact points of a patch, with an error where rounding matters.
class PointFactors {
 public:
  PointFactors(const ExactScene& scene, const std::vector<Part>& from, const Selection& to)
      : scene_(scene), from_(from), source_(scene.scene, to), near_(from.size()) {}

  struct Value {
    double value, error;
  };
  Value at(const Point& point, std::size_t part) {
    std::optional<NearPlanes>& near = near_[part];
    if (!near) near.emplace(scene_, from_[part]);
    const std::optional<Vec3> rounded = near->rounded(point);
    if (!rounded) return {0.5, 0.5};
    exact_form_factor(scene_.scene, {.point = *rounded, .normal = near->normal(), .on = near->own(), .id = {}}, source_,
                      {}, factor_);
    return {factor_.value, 0.0};
  }

 private:
  const ExactScene& scene_;
  const std::vector<Part>& from_;
  ExactSource source_;
  std::vector<std::optional<NearPlanes>> near_;  // made when asked for
  FormFactor factor_;
};

// With a probability in proportion to its area.
const SmallTriangle& drawn(const Strata& strata, const Stratum& stratum, Draws& draws) {
  std::size_t i = stratum.begin;
  for (double left = draws.unit() * stratum.area; i + 1 < stratum.end && left >= strata.triangles[i].area; ++i) {
    left -= strata.triangles[i].area;
  }
  return strata.triangles[i];
}

// Of means over the patch.
struct Look {
  double value = 0.0, unknown = 0.0;         // of F, and of its error
  double variance = 0.0, of_variance = 0.0;  // sums of the strata's variances, and of their squares
  double points = 0.0;
};

Look look_at(const ExactScene& scene, const std::vector<Part>& from, const Strata& strata, std::size_t number,
             PointFactors& factors) {
  Look look;
  double area = 0.0;
  for (const Stratum& stratum : strata.strata) area += stratum.area;
  for (std::size_t s = 0; s < strata.strata.size(); ++s) {
    kernel::poll();
    const Stratum& stratum = strata.strata[s];
    std::array<double, kTriples> means{};
    double unknown = 0.0;
    for (std::size_t t = 0; t < kTriples; ++t) {
      Draws draws(number, s, t);
      const SmallTriangle& triangle = drawn(strata, stratum, draws);
      for (const Point& point : triple_in(from[triangle.part], triangle, draws, scene.units)) {
        const auto [value, error] = factors.at(point, triangle.part);
        means[t] += value / 3.0;
        unknown += error / static_cast<double>(kPointsOfStratum);
      }
    }
    const double share = stratum.area / area;
    const double half = 0.5 * (means[0] - means[1]) * share, square = half * half;
    look.value += 0.5 * (means[0] + means[1]) * share;
    look.unknown += unknown * share;
    look.variance += square;
    look.of_variance += square * square;
  }
  look.points = static_cast<double>(strata.strata.size() * kPointsOfStratum);
  return look;
}

// The deviation that is exceeded with this probability. Where all points agree, a set that n points miss with this
// probability has at most a share of -log(risk) / n, and 0 <= F <= 1 on it.
double error_of(const Look& look, double risk) {
  if (!(look.of_variance > 0.0)) return look.unknown + std::min(1.0, -std::log(risk) / look.points);
  const double freedom = std::max(1.0, look.variance * look.variance / look.of_variance);
  const boost::math::students_t_distribution<double> student(freedom);
  const double t = boost::math::quantile(boost::math::complement(student, 0.5 * risk));
  return look.unknown + std::min(1.0, t * std::sqrt(look.variance));
}

}  // namespace

SampledIntegral sampled_integral(const ExactScene& scene, const std::vector<Part>& from, const Selection& to,
                                 std::size_t budget, double target) {
  std::size_t looks = 1;
  for (std::size_t strata = 4 * kFirstStrata; strata * kPointsOfStratum <= budget; strata *= 4) ++looks;
  PointFactors factors(scene, from, to);
  const double area = area_of(from);
  SampledIntegral result{0.5 * area, 0.5 * area};
  for (std::size_t number = 0, strata = kFirstStrata; number < looks; ++number, strata *= 4) {
    const Look look = look_at(scene, from, strata_of(from, strata), number, factors);
    const double error = error_of(look, kRisk / static_cast<double>(looks)) * area;
    if (error < result.error) result = {look.value * area, error};
    if (result.error <= target) break;
  }
  return result;
}

}  // namespace exactff::view_factors
