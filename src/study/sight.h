// What a receiver sees of a source, from the record of the exact method.
#pragma once

#include "exactff/study.h"

namespace exactff::study {

[[nodiscard]] Sight sight_of(const FormFactor& result);
// Of several planes or sources together.
[[nodiscard]] Sight joined(Sight a, Sight b);

// True where nothing but rays can tell the adaptive algorithm what is seen.
[[nodiscard]] bool needs_rays(const FormFactor& result);

}  // namespace exactff::study
