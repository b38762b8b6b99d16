// The CSV files of a study. Every file begins with comment lines (#) that state the version, the scene, the seeds and
// everything else that its values depend on; then comes one header row. Doubles are the shortest decimals that read
// back unchanged.
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "report/studies.h"

namespace exactff::report {

enum class Holds { kValues, kTimes };  // kValues: the same bytes on every run

struct StudyTable {
  std::string_view file;
  std::string_view holds;  // for the report's list of files
  void (*write)(const Study& study, std::ostream& out);
  bool (*has_rows)(const Study& study);  // a table without rows is left out
  Holds kind = Holds::kValues;
};

// In the order of the report's list.
[[nodiscard]] const std::vector<StudyTable>& tables();

// Those that compare the methods.
[[nodiscard]] const std::vector<StudyTable>& method_tables();

// The comment lines at the beginning of every file.
void write_head(const Study& study, std::ostream& out, std::string_view what);

// "light" or "lamp + window".
[[nodiscard]] std::string source_names(const Study& study);
// What --flip and --transparent have changed; often empty.
[[nodiscard]] std::string flipped_names(const Study& study);
[[nodiscard]] std::string transparent_names(const Study& study);

}  // namespace exactff::report
