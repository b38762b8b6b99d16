// Statistics of any numbers. All sums run in the given order, so that the bits are the same everywhere.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace exactff::kernel {

// Nearest rank: the smallest value that at least `percent` % of the values do not exceed. Requires at least one value,
// none of them NaN, and 0 < percent <= 100.
[[nodiscard]] double percentile(std::vector<double> values, double percent);

// The middle value, or the mean of the two middle values; 0 for an empty list.
[[nodiscard]] double median(std::vector<double> values);
[[nodiscard]] double mean(std::span<const double> values);
// Squares values / largest, so that nothing underflows or overflows. `largest`: of their magnitudes; 0 gives 0.
[[nodiscard]] double root_mean_square(std::span<const double> values, double largest);
// Half the width of the 95 % confidence interval of the mean, by Student's t; 0 for fewer than two values.
[[nodiscard]] double mean_half_width(std::span<const double> values);

// The exponent p of the least-squares line log y = p log x + c over the points with positive x and y. Nothing if there
// are fewer than two such points with different x.
[[nodiscard]] std::optional<double> fitted_slope(std::span<const std::pair<double, double>> points);

}  // namespace exactff::kernel
