// Statistics of the errors of a study. All sums run in the given order, so that the bits are the same
// everywhere.
#pragma once

#include <span>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

// All zero for an empty list. NaN and infinite values are counted and otherwise left out.
[[nodiscard]] ErrorStatistics error_statistics(std::span<const double> errors);

// Sets the error statistics of the cell from its errors.
void summarise(MethodCell& cell, const Study& study);
// Fits error = c * work^exponent over the rungs, for each seed separately.
[[nodiscard]] LadderSlopes slopes_of(const Study& study, std::size_t ladder);

[[nodiscard]] Summary summarise(const std::vector<SampleRow>& rows, const Study& study, double eps_b);
// The radiosity of the brightest receiver, largest channel.
[[nodiscard]] double largest_radiosity(const Study& study);

}  // namespace exactff::study
