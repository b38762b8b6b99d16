// Times, measured with nothing else at work.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

// Fills every `seconds` of a study that has its values, and what was set up once. A time is the median of three calls
// after a first one with the same arguments, or that first one where it is long; receivers come in an order that is
// spread over all of them, until the share of time for the setting is used up.
void measure_times(Study& study, const Hooks& hooks);

// The numbers below `count`, each once, such that any beginning of them is spread evenly.
[[nodiscard]] std::vector<std::size_t> spread_order(std::size_t count);

}  // namespace exactff::study
