// Bounds by doubles. With rounding to nearest (float_environment.h), the exact result of an operation lies between the
// two neighbours of the computed one. An infinite bound stays valid: the neighbour of an infinity is the largest
// double.
#pragma once

#include <cmath>
#include <limits>

namespace exactff::kernel {

[[nodiscard]] inline double below(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }
[[nodiscard]] inline double above(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }

}  // namespace exactff::kernel
