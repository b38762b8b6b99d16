// Where on a surface the visibility of the sources changes in kind: the edges of umbra and penumbra.
#pragma once

#include <span>
#include <variant>

#include "exactff/study.h"

namespace exactff::study {

// The one lattice that all receivers belong to; null if there is none.
[[nodiscard]] const Lattice* lattice_of(const std::vector<Receiver>& receivers);

// How a receiver sees each source: not at all, hidden, partly hidden or fully visible.
[[nodiscard]] std::vector<Sight> sights(const Scene& scene, const Receiver& receiver,
                                        std::span<const ExactSource> sources);

// See Study::edge_distance.
struct ShadowEdges {
  std::vector<double> distance;
  double resolution = 0.0;
};
// From a raster finer than the grid of receivers; or why there are none.
[[nodiscard]] std::variant<ShadowEdges, LeftOut> find_shadow_edges(const Request& request,
                                                                   std::span<const ExactSource> sources,
                                                                   const Hooks& hooks);

}  // namespace exactff::study
