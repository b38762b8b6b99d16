// Which settings of the sweeps are too expensive for a scene.
#pragma once

#include <span>

#include "exactff/study.h"

namespace exactff::study {

// The settings to leave out: those with the most planned work, but not the base, until the rest fits into
// Request::sweep_budget. In order of decreasing work. Requires exact values and settings. Work is counted at a few
// receivers and multiplied by fixed prices, so that the choice depends on the request alone.
[[nodiscard]] std::vector<std::size_t> over_budget(const Study& study, std::span<const ExactSource> sources,
                                                   const AdaptiveSolver& solver,
                                                   std::span<const AdaptiveSource> sampled_sources);

}  // namespace exactff::study
