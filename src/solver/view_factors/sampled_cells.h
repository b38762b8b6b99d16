// The integral over a refinement's cells (refinement.h), by random points on those that are not known.
//
// Refinement halves a cell until its error is small beside the sum of all, which in a crowd takes very many cells: the
// lines of constant visibility are long, and their cells add up. Points need the largest error to be small, not the
// sum: of cells with equal errors, an interval of a hundredth of the sum takes a few thousand points, however many
// cells there are. So whenever the refinement pauses, looks are taken (looks.h) at the cells of which only bounds are
// known, each with the point factor to its own part of the source. The integral over the others is added.
//
// What is done at a pause depends on the refinement's state alone, which does not depend on the accuracy: with a
// smaller one, there are only more pauses. All looks of all pauses share the risk.
//
// Rounding. As in sampled_factor.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "kernel/disc.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/refinement.h"

namespace exactff::view_factors {

// The probability that the interval misses the factor: of all looks together.
inline constexpr double kRiskOfCells = 0.5e-6;

class SampledCells {
 public:
  // Keeps references. `most`: points of all looks.
  SampledCells(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, std::size_t most);

  // Takes looks, each for a tenth of the width of what is known so far, until it is enough. They are expected to
  // take no more than this effort (Pair::effort).
  void look(const Refinement& cells, std::uint64_t effort,
            const std::function<bool(const kernel::Disc& integral)>& is_enough);
  // Takes one of all points that are left, if it should be narrower.
  void look_with_the_rest(const Refinement& cells);

  // The narrowest so far, by points or not, in squares of the unit of Point::at.
  [[nodiscard]] const kernel::Disc& enclosure() const { return narrowest_; }

 private:
  class FactorOfCells;
  class Round;

  // That the next look is for.
  [[nodiscard]] double next_radius() const;
  [[nodiscard]] std::size_t points_left() const { return most_ - std::min(most_, points_); }
  // At these cells, for the next radius, as far as is known.
  [[nodiscard]] double fewest_points(const Refinement::Apart& apart) const;
  void take_look(Round& round);

  const ExactScene& scene_;
  double smaller_area_;
  std::size_t most_;
  std::size_t looks_ = 0, points_ = 0;  // so far
  std::uint64_t effort_of_point_;       // in the last round
  kernel::Disc narrowest_;
};

}  // namespace exactff::view_factors
