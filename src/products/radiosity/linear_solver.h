// The only place that calls Eigen.
#pragma once

#include "radiosity/system.h"

namespace exactff::radiosity {

// (I - rho F) x = b, approximately, where F takes one of the three numbers of each entry. Empty if no x of finite
// numbers with a small residual is found. Nothing that is proved depends on the result.
[[nodiscard]] Numbers approximate_solution(const System& system, double Entry::*number, const Numbers& b);

}  // namespace exactff::radiosity
