// The errors of many values, and what there is to say of them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

// F*: the truth, or, where it is not certified, the point of its enclosure nearest to the value.
[[nodiscard]] double reference_of(double actual, const Expected& expected);
// Of max(|reference|, floor); 0 for no error, else infinite where both are 0.
[[nodiscard]] double relative_error(double error, double reference, double floor);

// The errors of values, one after the other. Refers to the truth and the values.
class Errors {
 public:
  Errors(const Truth& truth, const std::vector<Measured>& values, double relative_floor);

  using Index = std::uint32_t;  // into the values
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] bool is_finite(Index i) const;
  [[nodiscard]] double error(Index i) const { return error_[i]; }
  [[nodiscard]] double relative(Index i) const { return relative_[i]; }
  [[nodiscard]] std::optional<double> radiosity(Index i) const;
  // A magnitude: infinite for values that are not finite, 0 where rho B is not known.
  [[nodiscard]] double magnitude(Index i, Measure measure) const;
  [[nodiscard]] const TruthRow& truth_row(Index i) const { return truth_.rows[values_[i].row]; }
  [[nodiscard]] RowError row(Index i) const;

  // The largest by the measure; the first of equals. Requires at least one.
  [[nodiscard]] Index worst(const std::vector<Index>& among, Measure measure) const;
  // The `count` largest, the worst first; equals in the order of the truth. None without error.
  [[nodiscard]] std::vector<RowError> worst_rows(Measure measure, std::size_t count) const;

  [[nodiscard]] Statistics statistics(const std::vector<Index>& among) const;
  // Ascending, of the finite values.
  [[nodiscard]] std::vector<double> sorted_magnitudes(const std::vector<Index>& among, Measure measure) const;

 private:
  const Truth& truth_;
  const std::vector<Measured>& values_;
  std::vector<double> error_, relative_;
};

// The smallest of these that at least the given share of them does not exceed; 0 for none.
[[nodiscard]] double nearest_rank(const std::vector<double>& ascending, double share);

}  // namespace exactff::check
