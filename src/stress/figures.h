// The figures of a stress report: error, precision and time against the stiffness.
#pragma once

#include <vector>

#include "exactff/stress.h"
#include "page/figure.h"

namespace exactff::stress {

[[nodiscard]] std::vector<page::Figure> figures(const FamilyResult& result);

}  // namespace exactff::stress
