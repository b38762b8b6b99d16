// The CSV files that compare the methods.
#pragma once

#include <vector>

#include "report/tables.h"

namespace exactff::report {

[[nodiscard]] const std::vector<StudyTable>& method_tables();

}  // namespace exactff::report
