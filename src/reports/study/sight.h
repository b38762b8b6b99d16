// How a receiver sees a source, taken from the record of the exact method.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

[[nodiscard]] Sight sight_of(const FormFactor& result);
// For several planes or sources together.
[[nodiscard]] Sight joined(Sight a, Sight b);

// True if the adaptive algorithm needs rays to decide what is visible.
[[nodiscard]] bool needs_rays(const FormFactor& result);

// The receivers that a study examines in detail: evenly spaced among those that see the source partly, and for one
// third among those that see all of it; other receivers if there are too few. Ascending.
[[nodiscard]] std::vector<std::size_t> choose_receivers(const std::vector<ExactRow>& exact, std::size_t count);

}  // namespace exactff::study
