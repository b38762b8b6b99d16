// The CSV files that compare the methods.
#pragma once

#include <vector>

#include "report/tables.h"

namespace exactff::report {

[[nodiscard]] const std::vector<Table>& method_tables();

}  // namespace exactff::report
