// How a receiver sees a source, taken from the record of the exact method.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

[[nodiscard]] Sight sight_of(const FormFactor& result);
// For several planes or sources together.
[[nodiscard]] Sight joined(Sight a, Sight b);

// True if the adaptive algorithm needs rays to decide what is visible.
[[nodiscard]] bool needs_rays(const FormFactor& result);

}  // namespace exactff::study
