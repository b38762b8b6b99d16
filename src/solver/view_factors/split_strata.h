// Strata that are split where a function may be large, so that its mean is known best for a number of points.
#pragma once

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
  [[nodiscard]] Ranges ranges() const { return {largest(), squares_}; }
  // Cuts the stratum whose range times area is the largest: in two, but a triangle in three. False if it is too small.
  bool split();

 private:
  [[nodiscard]] double share(std::size_t stratum) const { return strata_.strata[stratum].area / strata_.area; }
  [[nodiscard]] double weight(std::size_t stratum) const { return ranges_[stratum] * share(stratum); }
  [[nodiscard]] double largest() const { return weight(heap_.front()); }
  [[nodiscard]] double range_of(const Stratum& stratum) const;
  [[nodiscard]] bool is_less_urgent(std::size_t a, std::size_t b) const;
  void put(std::size_t place, const Stratum& stratum, double most);
  void share_out(const Stratum& whole, double most, std::size_t place);
  void cut(const Tile& tile, double most, std::size_t place);

  const std::vector<Part>& parts_;
  RangeOf range_;
  Strata strata_;
  std::vector<double> ranges_;     // by stratum
  std::vector<std::size_t> heap_;  // of strata, that of the largest weight first
  double squares_ = 0.0;
};

}  // namespace exactff::view_factors
