// One view factor between two patches that are prepared.
#pragma once

#include "exactff/view_factors.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

class PairMemory;

// Whether A_i F_ij = A_j F_ji holds for the factors of this column, and may be used.
[[nodiscard]] bool is_symmetric(const PreparedPatch& column, const ViewFactorOptions& options);

// F_ij, `from` being patch i and `to` patch j.
[[nodiscard]] ViewFactor factor_between(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                                        const PreparedPatch& to, const ViewFactorOptions& options, PairMemory& memory);

// F_ji, from f = F_ij. Requires A_i F_ij = A_j F_ji.
[[nodiscard]] ViewFactor transpose(const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to);

}  // namespace exactff::view_factors
