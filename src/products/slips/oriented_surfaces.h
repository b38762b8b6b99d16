// Connected surfaces whose faces agree on which side is the front.
#pragma once

#include <cstdint>
#include <vector>

#include "exactff/scene.h"

namespace exactff::slips {

// By piece: the number of its surface, from 0. Two pieces that are alone at an edge, and run along it in opposite
// directions, belong to one surface; likewise the pieces of a face. Edges count in parts where ends of others lie on
// them (T-junctions). Where more than two pieces meet, an edge joins none of them.
[[nodiscard]] std::vector<std::uint32_t> oriented_surfaces(const Scene& scene);

}  // namespace exactff::slips
