// The parts of a stress report.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "page/chapter.h"
#include "stress/stress.h"

namespace exactff::stress {

struct StressTable {
  std::string_view file;
  std::string_view holds;  // for the report's list of files
  void (*write)(const Report& report, std::ostream& out);
};
// The CSV files, in the order of the report's list. Only timings.csv holds times.
[[nodiscard]] const std::array<StressTable, 3>& tables();

// Error, precision and time against the stiffness.
[[nodiscard]] std::vector<page::Figure> figures(const FamilyResult& result);

// One HTML page that loads nothing and has no scripts. `drawn` holds the figures of all families, in order.
[[nodiscard]] std::string report_page(const Report& report, const page::DrawnFigures& drawn);

}  // namespace exactff::stress
