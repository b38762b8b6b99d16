// The CSV files of a study. Every file begins with comment lines (#) that state the version, the scene, the
// seeds and all else that its values depend on; then one header row. Doubles are shortest round-trip decimals.
#pragma once

#include <array>
#include <ostream>
#include <string_view>

#include "exactff/study.h"

namespace exactff::study {

struct Table {
  std::string_view file;
  std::string_view holds;  // for the report's list of files
  void (*write)(const Study& study, std::ostream& out);
};

// In the order in which the report lists them.
[[nodiscard]] const std::array<Table, 5>& tables();

// "light" or "lamp + window".
[[nodiscard]] std::string source_names(const Study& study);

// What every output starts from: "exactff 0.1.0".
[[nodiscard]] std::string program_version();

}  // namespace exactff::study
