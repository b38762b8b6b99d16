// Statistics of any numbers. All sums run in the given order, so that the bits are the same everywhere.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace exactff::kernel {

// The middle value, or the mean of the two middle values; 0 for an empty list.
[[nodiscard]] double median(std::vector<double> values);
[[nodiscard]] double mean(std::span<const double> values);

// The smallest of these values that at least the share of them does not exceed; 0 if there are none. Requires
// 0 < share <= 1, and no NaN.
[[nodiscard]] double nearest_rank(std::vector<double> values, double share);
// Of the magnitudes of errors: the only place that says what RMS and quantiles of errors are. A quantile is by nearest
// rank. All are 0 for an empty list; with an infinite magnitude, the largest and the RMS are infinite.
struct Distribution {
  double median = 0.0, p90 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0, rms = 0.0;
};
[[nodiscard]] Distribution distribution(std::vector<double> magnitudes);

// Half the width of the 95 % confidence interval of the mean, by Student's t; 0 for fewer than two values.
[[nodiscard]] double mean_half_width(std::span<const double> values);

// The exponent p of the least-squares line log y = p log x + c over the points with positive x and y. Nothing if there
// are fewer than two such points with different x.
[[nodiscard]] std::optional<double> fitted_slope(std::span<const std::pair<double, double>> points);

}  // namespace exactff::kernel
