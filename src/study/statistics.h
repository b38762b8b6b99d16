// Statistics of errors and times. All sums run in the order given, so that they are the same bits everywhere.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

// All zero for an empty list. Values that are no numbers (or infinite) are counted and left out of the rest.
[[nodiscard]] ErrorStatistics error_statistics(std::span<const double> errors);

// Nearest rank: the smallest value that at least `percent` % of the values do not exceed. Requires numbers,
// at least one of them, and 0 < percent <= 100.
[[nodiscard]] double percentile(std::vector<double> values, double percent);

// The middle value, or the mean of the two middle ones; 0 for none.
[[nodiscard]] double median(std::vector<double> values);
[[nodiscard]] double mean(std::span<const double> values);

// Exponent p of the least-squares line log y = p log x + c over the points with positive x and y; nothing
// below two such points with different x.
[[nodiscard]] std::optional<double> fitted_slope(std::span<const std::pair<double, double>> points);

[[nodiscard]] Summary summarise(const std::vector<SampleRow>& rows, const Study& study, double eps_b);
// Of the brightest receiver, largest channel.
[[nodiscard]] double largest_radiosity(const Study& study);

// Times that are NaN were not measured.
[[nodiscard]] TimeSummary summarise_times(std::span<const double> seconds, const std::vector<ExactRow>& exact);

}  // namespace exactff::study
