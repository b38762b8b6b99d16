// JUnit XML as Jenkins, GitLab and others read it: one test suite with one test case for each verdict.
#pragma once

#include <optional>
#include <string>

#include "check/matrices.h"

namespace exactff::check {

// `matrix`: of the candidate, if matrices were compared.
[[nodiscard]] std::string junit_xml(const Report& report, const std::optional<MatrixFacts>& matrix = {});

}  // namespace exactff::check
