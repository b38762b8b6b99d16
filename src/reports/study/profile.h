// The radiosity along a line of receivers: the exact values and those of other methods.
#pragma once

#include <span>
#include <variant>

#include "exactff/study.h"

namespace exactff::study {

// Requires exact values and ladders. If the receivers are not a grid on a quadrilateral, or none sees the source
// partly, says so instead. The line is the row of the grid with the most such receivers.
[[nodiscard]] std::variant<Profile, LeftOut> find_profile(const Study& study, std::span<const ExactSource> sources,
                                                          const Hooks& hooks);

}  // namespace exactff::study
