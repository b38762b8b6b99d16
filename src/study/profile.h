// The radiosity along a line of receivers, exact and as others see it.
#pragma once

#include <span>

#include "exactff/study.h"

namespace exactff::study {

// Fills Study::profile where the receivers are a grid on a quadrilateral and some see the source partly; else says why
// not. The line is the row of the grid with the most of these.
void find_profile(Study& study, std::span<const ExactSource> sources, const Hooks& hooks);

}  // namespace exactff::study
