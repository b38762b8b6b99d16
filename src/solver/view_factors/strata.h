// Strata of a patch, of about the same area, and random points in them. Areas count with the weights of their parts.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/vec.h"
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
// All of the tile is at most so far from its middle, from point_at() there, too; with all roundings.
struct Reach {
  Vec3 middle;
  double radius;
};
[[nodiscard]] Reach reach_of(const Part& part, const Tile& tile);

// Of a stratum.
inline constexpr std::size_t kDraws = 2;

}  // namespace exactff::view_factors
