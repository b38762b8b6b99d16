// Strata that are split where a function may be large, so that its mean is known best for a number of points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "view_factors/strata.h"

namespace exactff::view_factors {

class SplitStrata {
 public:
  // The function lies in [0, range(tile)] on a tile.
  using RangeOf = std::function<double(const Tile& tile)>;

  // Begins with about `count` strata of the same area. Keeps a reference to the parts.
  SplitStrata(const std::vector<Part>& parts, std::size_t count, RangeOf range);

  [[nodiscard]] const Strata& strata() const { return strata_; }
  // A proved bound of the function on the stratum.
  [[nodiscard]] double range(std::size_t stratum) const { return ranges_[stratum]; }
  // Of a range times the stratum's share of the area.
  [[nodiscard]] double largest() const { return weight(heap_.front()); }
  // Of the function's mean on the stratum, within its range: 0, or what was set for the stratum that it was split from.
  [[nodiscard]] double guess(std::size_t stratum) const { return std::min(guesses_[stratum], ranges_[stratum]); }
  void set_guess(std::size_t stratum, double mean) { guesses_[stratum] = mean; }
  // Cuts the stratum whose range times area is the largest: in two, but a triangle in three. False if it is too small.
  bool split();

 private:
  [[nodiscard]] double share(std::size_t stratum) const { return strata_.strata[stratum].area / strata_.area; }
  [[nodiscard]] double weight(std::size_t stratum) const { return ranges_[stratum] * share(stratum); }
  [[nodiscard]] double range_of(const Stratum& stratum) const;
  [[nodiscard]] bool is_less_urgent(std::size_t a, std::size_t b) const;
  struct Known {
    double range, guess;
  };
  void put(std::size_t place, const Stratum& stratum, const Known& of_whole);
  void share_out(const Stratum& whole, const Known& of_whole, std::size_t place);
  void cut(const Tile& tile, const Known& of_whole, std::size_t place);

  const std::vector<Part>& parts_;
  RangeOf range_;
  Strata strata_;
  std::vector<double> ranges_, guesses_;  // by stratum
  std::vector<std::size_t> heap_;         // of strata, that of the largest weight first
};

}  // namespace exactff::view_factors
