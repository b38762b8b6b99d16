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
  double area = 0.0;               // of all
  double squares_of_shares = 0.0;  // sum of the squares of the strata's shares of it
  double largest_share = 0.0;
};

// About `count` strata, and not fewer. A part that is a parallelogram is cut into small ones; any other part into those
// of its fan's triangles. Each tile is a stratum, unless there are more than 2 `count`: then tiles in a row share one
// until it has an area of total / count, those of fragments (cut_at_contacts) only if there are more than 4 `count`. If
// only a few strata were shared, most of the variance would come from them, and the mean would not be nearly normal.
[[nodiscard]] Strata strata_of(const std::vector<Part>& parts, std::size_t count);

// The tile at a random place in the first or second half of the stratum's area, for its two draws. Where several tiles
// share a stratum, this leaves their mean without bias, and the estimate of its variance is too large on average: by
// the square of half the difference of the halves' means.
[[nodiscard]] const Tile& draw_tile(const Strata& strata, const Stratum& stratum, std::size_t draw, Draws& draws);

// Points each of which is uniform in the tile, and whose mean is the tile's centre, so that the mean of a linear
// function at them is exact: of a parallelogram two, opposite each other; of a triangle three, with the same weights in
// turn at its corners.
[[nodiscard]] std::vector<Point> points_in(const Part& part, const Tile& tile, Draws& draws, const Units& units);
inline constexpr std::size_t kFewestPoints = 2;  // of a draw

// The points of one of the two draws of a stratum, in one part.
struct Sample {
  std::size_t part;
  std::vector<Point> points;
};
inline constexpr std::size_t kDraws = 2;
[[nodiscard]] Sample sample(const std::vector<Part>& parts, const Strata& strata, std::size_t look, std::size_t stratum,
                            std::size_t draw, const Units& units);

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
  // Exceeded with a probability of at most `risk`. Where all numbers agree, the function may differ where no point was.
  // Let the set where it does have a share p_s of stratum s. Both draws miss it with a probability of at most the
  // product of (1 - p_s)^2 <= exp(-2 sum p_s), which is the risk if the sum is -log(risk) / 2, and the set's share of
  // all is at most this sum times the largest share of a stratum. (The points of one draw are not independent.)
  [[nodiscard]] double error(double risk, const Strata& strata) const;
};

}  // namespace exactff::view_factors
