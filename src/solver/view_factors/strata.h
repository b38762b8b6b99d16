// Strata of a patch, of about the same area, and random points in them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "view_factors/patch_parts.h"

namespace exactff::view_factors {

inline constexpr std::size_t kFewestStrata = 36;

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

// What the points of one draw lie in: a small parallelogram of a grid or, along the side opposite corner 0 of a part's
// triangle, half of one.
struct Tile {
  enum class Shape { kParallelogram, kTriangle };
  std::size_t part, second, third;  // corners of the part; its corner 0 is the grid's origin
  std::uint32_t columns, rows;      // of the grid, on the sides from corner 0 to `second` and to `third`
  std::uint32_t column, row;
  Shape shape;
  double area;
};

struct Stratum {
  std::size_t begin, end;  // tiles
  double area;
};

struct Strata {
  std::vector<Tile> tiles;
  std::vector<Stratum> strata;
  double area = 0.0;  // of all
};

// About `count` strata, and not fewer. A part that is a parallelogram is cut into small ones; any other part into those
// of its fan's triangles. Each tile is a stratum, unless there are more than 2 `count`: then tiles in a row share one
// until it has an area of total / count, those of fragments (cut_at_contacts) only if there are more than 4 `count`. If
// only a few strata were shared, most of the variance would come from them.
[[nodiscard]] Strata strata_of(const std::vector<Part>& parts, std::size_t count);

// The tile at a random place in the first or second half of the stratum's area, for its two draws. Where several tiles
// share a stratum, this leaves their mean without bias, and the estimate of its variance is too large on average: by
// the square of half the difference of the halves' means.
[[nodiscard]] const Tile& draw_tile(const Strata& strata, const Stratum& stratum, std::size_t draw, Draws& draws);

// Uniform in the tile.
[[nodiscard]] Point point_in(const Part& part, const Tile& tile, Draws& draws, const Units& units);

// Its corners, in the order of the part's, rounded once.
[[nodiscard]] std::vector<Vec3> corners_of(const Part& part, const Tile& tile, const Units& units);

// Of a stratum.
inline constexpr std::size_t kDraws = 2;

// Proved bounds of a function on strata: it lies in [0, R_s] on stratum s, with the share w_s of the area.
struct Ranges {
  double largest = 0.0;  // of w_s R_s
  double squares = 0.0;  // the sum of (w_s R_s)^2

  void add(double range, double share);
};

// The mean over the strata of a function, from two independent numbers a_s and b_s in each.
//
// It is the sum of independent terms w_s a_s / 2 and w_s b_s / 2, which lie in [0, r] with r = max w_s R_s / 2. Let V
// be its variance. D_s = (w_s (a_s - b_s) / 2)^2 has a mean of at least the variance of stratum s, and lies in
// [0, r^2]. No stratum is believed for agreeing with itself: nothing is assumed of the function but its ranges. Three
// bounds of the error hold together with a probability of 1 - risk:
//
//   Bernstein     e = r L / 3 + sqrt((r L / 3)^2 + 2 V L),  L = log(8 / risk). V is not known, but a sum S of
//                 independent numbers in [0, r^2] falls below its mean M by t or more with a probability of at most
//                 exp(-t^2 / (2 r^2 M)) (Maurer, J. Inequal. Pure Appl. Math. 4(1), 2003). So with S the sum of the
//                 D_s and l = log(4 / risk), sqrt(V) <= sqrt(M) <= (sqrt(2 r^2 l) + sqrt(2 r^2 l + 4 S)) / 2, except
//                 with a probability of risk / 4. (As Maurer and Pontil, "Empirical Bernstein Bounds", COLT 2009, but
//                 with differences inside strata.)
//   Hoeffding     e = sqrt(log(8 / risk) sum (w_s R_s)^2) / 2 (J. Am. Stat. Assoc. 58, 1963).
//   none is met   If all numbers are 0: let the function be positive on the share p_s of stratum s. Both numbers are 0
//                 with a probability of at most (1 - p_s)^2 <= exp(-2 p_s), of all strata exp(-2 sum p_s), which is
//                 risk / 4 if the sum is l / 2. The mean is at most sum w_s R_s p_s <= l / 2 max w_s R_s.
//
// The points of one draw are not independent, and need not be. Where two draws of a stratum lie in different halves of
// it, their mean has no bias, the mean of D_s is even larger, and (1 - p)(1 - q) <= exp(-(p + q)) as well.
struct StratifiedMean {
  double value = 0.0;
  double square = 0.0;  // the sum of the D_s

  // The numbers of a stratum with this share of the area.
  void add(double a, double b, double share);
  // Exceeded with a probability of at most `risk`.
  [[nodiscard]] double error(double risk, const Ranges& ranges) const;
  // The same where the function is only known to lie between f, whose mean this is, and f + u, both within the ranges;
  // `unknown` is the mean of u. Both bounds have half of the risk. The differences of f + u are at most the sums of
  // those of f and of u, so their squares add up to at most the square of the sum of the two roots (Minkowski).
  [[nodiscard]] double error(double risk, const Ranges& ranges, const StratifiedMean& unknown) const;
};

}  // namespace exactff::view_factors
