// Workflow commands of GitHub Actions: lines that the runner turns into annotations on files.
#pragma once

#include <string>

#include "exactff/check.h"

namespace exactff::check {

// An ::error for every verdict that failed, a ::warning for anything doubtful.
[[nodiscard]] std::string github_annotations(const Report& report);
[[nodiscard]] std::string github_annotations(const InputError& error);

}  // namespace exactff::check
