// Strata of a patch, of about the same area, and random points in them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "view_factors/patch_parts.h"

namespace exactff::view_factors {

inline constexpr std::size_t kFewestStrata = 36;  // for an interval of Student's t; with fewer it is too narrow

// Counter-based random numbers: the n-th number depends on the key alone. Different keys, independent numbers.
class Draws {
 public:
  Draws(std::size_t look, std::size_t stratum, std::size_t number);
  std::uint64_t bits();
  double unit();  // in [0, 1)

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
  double area = 0.0;               // of all
  double squares_of_shares = 0.0;  // sum of the squares of the strata's shares of it
};

// About `count` strata: small triangles in a row share one until it has an area of total / count.
[[nodiscard]] Strata strata_of(const std::vector<Part>& parts, std::size_t count);

// A triangle of the stratum, with a probability in proportion to its area.
[[nodiscard]] const SmallTriangle& drawn(const Strata& strata, const Stratum& stratum, Draws& draws);

// Three points with the same weights in turn at the triangle's corners. Each is uniform in the triangle; their mean is
// the centre, so the mean of a linear function at them is exact.
[[nodiscard]] std::array<Point, 3> triple_in(const Part& part, const SmallTriangle& triangle, Draws& draws,
                                             const Units& units);

// The mean over the strata of a function between 0 and 1, from two independent numbers in each: their mean has a
// variance that (difference / 2)^2 estimates without bias. The strata's variances add up; their sum has an estimated
// number of degrees of freedom (Welch, Biometrika 34, 1947), for which Student's t gives the interval.
//
// Where a few strata vary most, there are few degrees of freedom, and the bound of Hoeffding (J. Am. Stat. Assoc. 58,
// 1963) may be narrower. The mean is a sum of independent terms, two of each stratum, between 0 and half its share s.
// So it is off by e or more with a probability of at most 2 exp(-4 e^2 / sum s^2). Each bound has half of the risk.
struct StratifiedMean {
  double value = 0.0;
  double variance = 0.0, of_variance = 0.0;  // sums of the strata's variances, and of their squares

  // The numbers of a stratum with this share of the area.
  void add(double a, double b, double share);
  // Exceeded with the probability `risk`. Where all numbers agree, a set that n points miss with this probability has
  // at most a share of -log(risk) / n.
  [[nodiscard]] double error(double risk, double points, const Strata& strata) const;
};

}  // namespace exactff::view_factors
