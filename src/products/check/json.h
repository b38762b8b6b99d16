// The report as JSON, for other programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/baseline.h"
#include "check/matrices.h"

namespace exactff::check {

// The whole report, with the facts of the candidate if matrices were compared, and what got better than the baseline.
[[nodiscard]] std::string json_text(const Report& report, const std::optional<MatrixFacts>& matrix = {},
                                    const std::vector<Improvement>& improvements = {});

}  // namespace exactff::check
