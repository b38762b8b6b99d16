// The methods of a study against one another.
#pragma once

#include "exactff/study.h"
#include "study/kept_work.h"

namespace exactff::study {

// Values of every ladder at a choice of receivers, and of its middle rung at all of them. `study` has its exact values;
// what is left out is added to it.
[[nodiscard]] MethodStudy run_methods(Study& study, const KeptWork& kept, const Hooks& hooks);

// The receivers that a study looks at more closely: evenly spaced among those that see the source partly, a third of
// them among those that see all of it; others where there are too few. Ascending.
[[nodiscard]] std::vector<std::size_t> choose_receivers(const std::vector<ExactRow>& exact, std::size_t count);

// What a method's counted work is planned to take, in seconds: fixed prices, so that no plan depends on a clock.
[[nodiscard]] double planned_seconds(const methods::Counters& counters, std::size_t faces);

}  // namespace exactff::study
