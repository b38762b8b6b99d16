// The errors of many values and their statistics.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

// In the relative mean square error of images, e^2 / (t^2 + this), as papers on denoising have it: e is the error, t
// the truth.
inline constexpr double kRelativeMseEpsilon = 0.01;

inline constexpr std::string_view kImage = "image";  // the kind of a truth of pixels

// F*: the true value; if it is not certified, the point of its enclosure nearest to `actual`.
[[nodiscard]] double reference_of(double actual, const Expected& expected);
// The error divided by max(|reference|, floor). 0 if the error is 0; otherwise infinite if both are 0.
[[nodiscard]] double relative_error(double error, double reference, double floor);

// The errors of all values, in the order of the values. Keeps references to the truth and the values.
class Errors {
 public:
  Errors(const Truth& truth, const std::vector<Measured>& values, double relative_floor);

  using Index = std::uint32_t;  // index into the values
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] bool is_finite(Index i) const;
  [[nodiscard]] std::optional<double> radiosity(Index i) const;
  // The magnitude of the error: infinite for values that are not finite, 0 if rho B is not known.
  [[nodiscard]] double magnitude(Index i, Measure measure) const;
  [[nodiscard]] const TruthRow& truth_row(Index i) const { return truth_.rows[values_[i].row]; }
  [[nodiscard]] RowError row(Index i) const;

  // The value with the largest magnitude; the first one if several are equal. Requires at least one.
  [[nodiscard]] Index worst(const std::vector<Index>& among, Measure measure) const;
  // The `count` largest errors, the worst first; equal ones in the order of the truth. Values without error are left
  // out.
  [[nodiscard]] std::vector<RowError> worst_rows(Measure measure, std::size_t count) const;

  [[nodiscard]] Statistics statistics(const std::vector<Index>& among) const;
  // The magnitudes of the finite values, ascending.
  [[nodiscard]] std::vector<double> sorted_magnitudes(const std::vector<Index>& among, Measure measure) const;

 private:
  [[nodiscard]] Distribution distribution(const std::vector<Index>& among, Measure measure) const;

  const Truth& truth_;
  const std::vector<Measured>& values_;
  std::vector<double> error_, relative_;
};

}  // namespace exactff::check
