// Where the light goes. For each patch, A_i B_i leaves it, and A_i H_i = A_i sum_j F_ij B_j arrives.
//
// Bounce by bounce, b^0 = E and b^(n+1) = rho F b^n; B is the sum of all b^n. Let P_n = sum A_i b_i^n. Of P_n, the part
// sum A_i b_i^n back_i meets backs and sum A_i b_i^n open_i leaves. Where A_i F_ij = A_j F_ji and the rows add up to 1,
// the rest arrives:
//   sum_i A_i (F b^n)_i = sum_j A_j b_j^n sum_i F_ji = sum_j A_j b_j^n (1 - back_j - open_j)
// Of this, sum A_i (1 - rho_i) (F b^n)_i is absorbed, and sum A_i rho_i (F b^n)_i = P_(n+1) leaves again. So
//   P_n = absorbed_n + back_n + open_n + P_(n+1),   P_0 = emitted,
//   emitted = (what bounces 0 to N lose to the three) + P_(N+1).
//
// Four inequalities follow. They clip the sums, which are as wide as the view factors make them.
// 1. back, open >= 0: no factor of their products is negative.
// 2. absorbed >= 0 if every rho_i <= 1: likewise.
// 3. absorbed + back + open <= emitted if every rho_i <= 1: P_(N+1) >= 0 for every N, and the three sums over the
//    bounces do not fall. This holds even where B is infinite.
// 4. absorbed + back + open = emitted if B is finite: P_n -> 0. No rho is limited.
// So each of the three is at most emitted less the others' lower bounds (3 or 4), and at least emitted less the others'
// upper bounds (4). 3 and 4 need reciprocity and rows that add up to 1; Solution::reasons_against_balance is empty
// then.
//
// back_i and open_i need not be computed: where a row adds up to 1, back_i + open_i = 1 - sum_j F_ij, its loss, and
// each of the two is at most that. It is 0 where that is proved (ProvedZeros), and the loss where the other is 0.
#pragma once

#include <vector>

#include "exactff/radiosity.h"
#include "radiosity/system.h"

namespace exactff::radiosity {

// What is known of the system, for the inequalities.
struct Laws {
  bool loses_at_each_bounce = false;  // every rho_i <= 1
  bool adds_up = false;               // reciprocity, and rows that add up to 1
  bool is_finite = false;             // B is
};

// Of what leaves a patch, the shares that meet backs, leave, or do either.
struct Losses {
  std::vector<matrix::Sum> back, open, lost;
  bool is_possible = true;  // the bounds of every row hold 1, as far as it must add up to 1
};
[[nodiscard]] Losses losses_of(const Scene& scene, const matrix::Matrix& matrix, bool adds_up);

// Sums of products, rounded outward, clipped by 1 and 2. The channel has its radiosities and irradiances.
[[nodiscard]] Balance sums_of(const Channel& channel, const System& system, const std::vector<double>& areas,
                              const Losses& losses, const Laws& laws);

// Whether the sums contradict 4: then some bound does not hold.
[[nodiscard]] bool is_contradiction(const Balance& sums);

// Clipped by 3 and 4 as well. Requires sums that are no contradiction, if B is finite.
[[nodiscard]] Balance clip(const Balance& sums, const Laws& laws);

}  // namespace exactff::radiosity
