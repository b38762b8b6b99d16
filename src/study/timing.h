// Measures times, with nothing else running.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

// Fills every `seconds` of a study that has its values, and the setup times. A time is the median of three calls after
// a first call with the same arguments; if the first call is long, it is the time. Receivers are timed in an order that
// is spread over all of them, until the time reserved for the setting is used up.
void measure_times(Study& study, const Hooks& hooks);

// A permutation of the numbers below `count` whose every prefix is spread evenly.
[[nodiscard]] std::vector<std::size_t> spread_order(std::size_t count);

}  // namespace exactff::study
