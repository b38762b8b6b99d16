// Two numbers of a stratum, the guesses of which are constants.
#pragma once

#include "view_factors/stratified_mean.h"

namespace exactff::view_factors {

// The first one's guess is given, the second one's is the first number. `share`: of the area, of the stratum.
inline void add_numbers(StratifiedMean& mean, double a, double b, double guess, double share) {
  mean.add(a, guess, guess, 0.5 * share);
  mean.add(b, a, a, 0.5 * share);
}

}  // namespace exactff::view_factors
