// Two numbers of a stratum, the control variates of which are constants.
#pragma once

#include "view_factors/strata.h"

namespace exactff::view_factors {

// The first one's control variate is given, the second one's is the first number. `share`: of the area, of the stratum.
inline void add_numbers(StratifiedMean& mean, double a, double b, double control, double share) {
  mean.add(a, control, control, 0.5 * share);
  mean.add(b, a, a, 0.5 * share);
}

}  // namespace exactff::view_factors
