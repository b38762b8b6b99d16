// Intervals for readers.
#pragma once

#include <limits>
#include <string>

namespace exactff::text {

// "[0.812, 1]": the ends are rounded outward by at most a hundredth of the width, so that they hold what the interval
// holds. "1.01773" if both ends round to the same six digits. An end that would be rounded beyond the limit is shown as
// the limit, to six digits.
[[nodiscard]] std::string interval(double lower, double upper, double limit = std::numeric_limits<double>::infinity());

}  // namespace exactff::text
