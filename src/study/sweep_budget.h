// Which settings of the sweeps are too expensive for a scene.
#pragma once

#include <span>

#include "exactff/study.h"

namespace exactff::study {

// Leaves out the settings with the most planned work, but not the base, until the rest fits into Request::sweep_budget;
// records which. Work is counted at a few receivers and multiplied by fixed prices, so that the choice depends on the
// request alone.
void keep_to_budget(Study& study, std::span<const ExactSource> sources, const AdaptiveSolver& solver,
                    std::span<const AdaptiveSource> sampled_sources);

}  // namespace exactff::study
