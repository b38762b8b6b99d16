// The radiosity along a line of receivers: the exact values and those of other methods.
#pragma once

#include <span>

#include "exactff/study.h"

namespace exactff::study {

// Fills Study::profile if the receivers are a grid on a quadrilateral and some see the source partly; otherwise records
// the reason. The line is the row of the grid with the most such receivers.
void find_profile(Study& study, std::span<const ExactSource> sources, const Hooks& hooks);

}  // namespace exactff::study
