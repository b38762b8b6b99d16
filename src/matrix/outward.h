// The doubles next to a sum: bounds are rounded outward.
#pragma once

#include <cmath>
#include <limits>

namespace exactff::matrix {

inline double below(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }
inline double above(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }

}  // namespace exactff::matrix
