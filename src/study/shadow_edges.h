// Where on a face what is visible of the sources changes in kind: the edges of umbra and penumbra.
#pragma once

#include <span>

#include "exactff/study.h"

namespace exactff::study {

// A grid of receivers on a face.
struct ReceiverGrid {
  FaceId face{};
  GridSize size;
};

// The one grid that all receivers belong to, if there is one.
[[nodiscard]] std::optional<ReceiverGrid> grid_of(const std::vector<Receiver>& receivers);

// Which of the sources a receiver sees: nothing, hidden, partly or all of each.
[[nodiscard]] std::vector<Sight> sights(const Scene& scene, const Receiver& receiver,
                                        std::span<const ExactSource> sources);

// Fills Study::edge_distance from a raster finer than the grid of receivers; else says why not.
void find_shadow_edges(Study& study, std::span<const ExactSource> sources, const Hooks& hooks);

}  // namespace exactff::study
