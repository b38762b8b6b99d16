// Measures times, with nothing else running.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

// Times every setting that a study with its values has run, as MethodCell describes it, and sets all times of the study
// but that of the ray-tracing structure. Which receivers a setting is timed at depends on counted work alone, so that
// its time means the same in every run. Throws std::logic_error if a value is not that of the study.
void measure_times(Study& study, const Hooks& hooks);

// A permutation of the numbers below `count` whose every prefix is spread evenly.
[[nodiscard]] std::vector<std::size_t> spread_order(std::size_t count);

// Every prefix is spread evenly, and has about the same share of receivers that see the source partly.
[[nodiscard]] std::vector<std::size_t> order_of_timing(const std::vector<std::size_t>& receivers,
                                                       const std::vector<ExactRow>& exact);

}  // namespace exactff::study
