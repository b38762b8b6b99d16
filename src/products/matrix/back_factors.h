// For each row, what it sees of backs.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "exactff/view_factors.h"
#include "matrix/surroundings.h"
#include "view_factors/pairs.h"

namespace exactff::matrix {

class BackFactors {
 public:
  BackFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options);

  // Of the row's patch, without its area. From any thread.
  [[nodiscard]] ViewFactor of_row(std::size_t row) const;

 private:
  struct Term {
    std::size_t column;
    bool is_subtracted;
  };
  [[nodiscard]] std::vector<Term> terms_of(std::size_t row) const;
  [[nodiscard]] double find_area() const;

  double accuracy_;
  SceneWithBacks made_;
  std::vector<Selection> columns_;
  view_factors::Pairs pairs_;
  double area_;
};

// For factors to columns that are not patches: the other direction is not asked for, but may give this one.
[[nodiscard]] ViewFactorOptions as_one_direction(const ViewFactorOptions& options);

// Also where rows are equal, and so one pair gives several entries. `finer`: see Pairs::compute.
[[nodiscard]] ViewFactor factor_of(const view_factors::Pairs& pairs, std::size_t entry, double finer = 1.0);

}  // namespace exactff::matrix
