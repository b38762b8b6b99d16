// One view factor between two patches that are prepared.
#pragma once

#include "exactff/view_factors.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

class PairMemory;

// Whether A_i F_ij = A_j F_ji may give the one from the other.
[[nodiscard]] bool is_symmetric(const PreparedPatch& i, const PreparedPatch& j, const ViewFactorOptions& options);

// F_ij, `from` being patch i and `to` patch j.
[[nodiscard]] ViewFactor factor_between(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                                        const PreparedPatch& to, const ViewFactorOptions& options, PairMemory& memory);

// F_ji, from f = F_ij. Requires A_i F_ij = A_j F_ji: planar patches.
[[nodiscard]] ViewFactor transpose(const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to);

}  // namespace exactff::view_factors
