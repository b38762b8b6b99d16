// What the commands that compute view factors say alike.
#pragma once

#include <string>

#include "exactff/matrix.h"

namespace exactff::cli {

// Warns of the entries that are wider than the accuracy.
void warn_of_width(const matrix::Matrix& matrix, const ViewFactorOptions& options);
void warn_of_width(const matrix::Matrix& draft, const matrix::DraftOptions& options);

// "0.199825 +- 3e-07".
[[nodiscard]] std::string interval_text(const matrix::Sum& interval);

inline constexpr const char* kTwoSidedHelp =
    "Patches or faces whose backs are patches as well, NAME (back), with the same Kd and Ke";

}  // namespace exactff::cli
