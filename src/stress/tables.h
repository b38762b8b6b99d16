// The CSV files of a stress report.
#pragma once

#include <array>
#include <ostream>
#include <string_view>

#include "exactff/stress.h"

namespace exactff::stress {

struct StressTable {
  std::string_view file;
  std::string_view holds;  // for the report's list of files
  void (*write)(const Report& report, std::ostream& out);
};

// In the order of the report's list. Only timings.csv holds times.
[[nodiscard]] const std::array<StressTable, 3>& tables();

}  // namespace exactff::stress
