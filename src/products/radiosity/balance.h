// Where the light goes. For each patch, A_i B_i leaves it, and A_i H_i = A_i sum_j F_ij B_j arrives. By A_i F_ij =
// A_j F_ji, the sum of what arrives at all patches is that of what leaves them, without what meets backs or nothing:
//   sum A_i H_i = sum_j A_j B_j sum_i F_ji = sum_j A_j B_j (1 - back_j - open_j)
// With B_i = E_i + rho_i H_i this gives
//   sum A_i E_i = sum A_i (1 - rho_i) H_i + sum A_i B_i back_i + sum A_i B_i open_i
#pragma once

#include "exactff/radiosity.h"
#include "radiosity/system.h"

namespace exactff::radiosity {

// Rounded outward. The channel has its radiosities and irradiances.
[[nodiscard]] Balance balance_of(const Channel& channel, const System& system, const matrix::Matrix& matrix);

}  // namespace exactff::radiosity
