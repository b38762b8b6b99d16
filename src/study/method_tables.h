// The CSV files that compare the methods.
#pragma once

#include <vector>

#include "study/tables.h"

namespace exactff::study {

[[nodiscard]] const std::vector<Table>& method_tables();

}  // namespace exactff::study
