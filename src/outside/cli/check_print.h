// What `exactff check` prints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/baseline.h"
#include "check/matrices.h"

namespace exactff::cli {

// `matrix`: of the candidate, if matrices were compared. `baseline_to_tighten`: the file to suggest for improvements;
// empty if none is to be suggested.
void print_check(const check::Report& report, const std::optional<check::MatrixFacts>& matrix,
                 const std::vector<check::Improvement>& improvements, const std::string& baseline_to_tighten);

}  // namespace exactff::cli
