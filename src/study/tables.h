// The CSV files of a study. Every file begins with comment lines (#) that state the version, the scene, the
// seeds and all else that its values depend on; then one header row. Doubles are shortest round-trip decimals.
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

enum class Holds { kValues, kTimes };  // values are the same bytes on every run

struct Table {
  std::string_view file;
  std::string_view holds;  // for the report's list of files
  void (*write)(const Study& study, std::ostream& out);
  bool (*has_rows)(const Study& study);  // it is left out where it has none
  Holds kind = Holds::kValues;
};

// In the order in which the report lists them.
[[nodiscard]] const std::vector<Table>& tables();

// The comment lines that every file begins with.
void write_head(const Study& study, std::ostream& out, std::string_view what);

// "light" or "lamp + window".
[[nodiscard]] std::string source_names(const Study& study);

// What every output starts from: "exactff 0.1.0".
[[nodiscard]] std::string program_version();

}  // namespace exactff::study
