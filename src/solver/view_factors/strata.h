// Strata of a patch, of about the same area, and random points in them. Areas count with the weights of their parts.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "kernel/vec.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

inline constexpr std::size_t kFewestStrata = 36;

// Counter-based random numbers: the n-th number depends on the key alone. Different keys, independent numbers.
class Draws {
 public:
  Draws(std::size_t analysis, std::size_t stratum, std::size_t number);
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
  double area;  // times the part's weight
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

// A place in a tile: shares of its sides from its corner nearest the origin.
struct Place {
  double along = 0.0, up = 0.0;
};
// The mean of all places, within 2^-32.
[[nodiscard]] Place middle_of(const Tile& tile);

// Uniform in the tile.
[[nodiscard]] Place draw_place(const Tile& tile, Draws& draws);
// Exactly there, with the shares rounded down to multiples of 2^-32.
[[nodiscard]] Point point_at(const Part& part, const Tile& tile, const Place& place, const Units& units);

// Within 2^-48 if no coordinate is larger than 1.
struct Sides {
  Vec3 origin, along, up;

  [[nodiscard]] Vec3 at(const Place& place) const;
};
[[nodiscard]] Sides sides_of(const Part& part, const Tile& tile);
// In the order of the part's.
[[nodiscard]] std::vector<Vec3> corners_of(const Part& part, const Tile& tile);
// Of a stratum.
inline constexpr std::size_t kDraws = 2;

// --- Split strata ---

// Strata that are split where a function may be large, so that its mean is known best for a number of points.

class SplitStrata {
 public:
  // On the tile, the function lies between 0 and this, which is at most 1.
  using RangeOf = std::function<double(const Tile& tile)>;

  // Begins with about `count` strata of the same area. Keeps a reference to the parts.
  SplitStrata(const std::vector<Part>& parts, std::size_t count, RangeOf range);

  [[nodiscard]] const Strata& strata() const { return strata_; }
  [[nodiscard]] double range(std::size_t stratum) const { return known_[stratum].range; }
  // r of StratifiedMean.
  [[nodiscard]] double largest_term() const { return waiting_.front().term; }
  // What its terms are expected to add to Q: what was set for the stratum that it was split from, and less with each
  // split.
  void set_square(std::size_t stratum, double square);
  [[nodiscard]] double sum_of_squares() const { return sum_of_squares_; }

  // Cuts the stratum of the largest term: in two, but a triangle in three. False if it is too small.
  bool split_largest_term();

 private:
  struct Known {
    double range = 1.0, square = 0.0;
  };
  struct Waiting {
    double term;
    std::size_t stratum;
  };

  [[nodiscard]] static bool is_less_urgent(const Waiting& a, const Waiting& b);
  [[nodiscard]] double share(std::size_t stratum) const { return strata_.strata[stratum].area / strata_.area; }
  [[nodiscard]] double range_of(const Stratum& stratum) const;
  [[nodiscard]] static Known part_of(const Known& known, double share);
  void put(std::size_t place, const Stratum& stratum, const Known& of_whole);
  void share_out(const Stratum& whole, const Known& known, std::size_t place);
  void cut(const Tile& tile, const Known& known, std::size_t place);

  const std::vector<Part>& parts_;
  RangeOf range_;
  Strata strata_;
  std::vector<Known> known_;  // by stratum
  double sum_of_squares_ = 0.0;
  std::vector<Waiting> waiting_;  // a heap of all strata, the largest term first
};

// --- Stratified mean ---

// The mean over strata of a function of which nothing is known but how far it is, at most, from control variates.
//
// In each stratum, a few independent places are drawn. The function's mean is the sum of the means of independent terms
// X_i, each the function at a place times the share of the area that the place stands for. Each term has a control
// variate p_i, a function of the place of which the mean is known, chosen before the place is drawn: it may depend on
// all that was drawn before. Let no |X_i - p_i| exceed r, wherever the place is, and let Q be the sum of (X_i - p_i)^2.
// For any L and any c in (0, 1), chosen like r before the places, each of
//
//   mean >= V - e   and   mean <= V + e,   V = sum (X_i - p_i + mean of p_i),   e = (r L + psi Q / r) / c,
//
// with psi = -log(1 - c) - c, holds but with a probability of at most exp(-L). No stratum is believed for agreeing with
// itself: even with Q = 0, e is more than r L. No interval that holds for all such functions can be narrower by much.
// Let two places be drawn in each stratum, of a function in [0, R]. Without any number that meets it, it may have a
// mean of r L: a share p_s of each stratum goes unmet with a probability of exp(-2 sum p_s).
//
// Proof (Fan, Grama, Liu, "Exponential inequalities for martingales with applications", Electron. J. Probab. 20, 2015;
// Howard, Ramdas, McAuliffe, Sekhon, "Time-uniform, nonparametric, nonasymptotic confidence sequences", Ann. Stat. 49,
// 2021). (log(1 + y) - y) / y^2 increases with y > -1. So for x >= -1, y = c x is at least -c, and
// exp(c x - psi x^2) <= 1 + c x. With x = (X_i - p_i) / r, and d_i its mean given what came before, times r,
//
//   E exp(c (X_i - p_i) / r - psi (X_i - p_i)^2 / r^2) <= 1 + c d_i / r <= exp(c d_i / r),
//
// so E exp(c (X_i - p_i - d_i) / r - psi (X_i - p_i)^2 / r^2) <= 1, whatever came before. The product over all terms
// has a mean of at most 1, too, and exceeds exp(L) with a probability of at most exp(-L) (Markov's inequality). The sum
// of X_i - p_i - d_i is V less the mean. The same holds for x = (p_i - X_i) / r. Where the draws of a stratum lie in
// different halves of it, the means of their X_i differ, but add up to what they should.

struct StratifiedMean {
  // Of the square, from before the analysis. It chooses c; the worse it is, the larger is the error.
  double expected = 0.0;
  double value = 0.0;
  double square = 0.0;  // Q

  // A number, its control variate at the same place, and the mean of that; `share`: of the area, that it stands for.
  void add(double number, double control, double mean_of_control, double share);
  // e. The mean of the function lies within it of the value, but with a probability of at most `risk`.
  [[nodiscard]] double error(double r, double risk) const;
};

}  // namespace exactff::view_factors
