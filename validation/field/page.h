// The results as a chapter of a report, and as a page of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "field/results.h"
#include "report/report.h"

namespace exactff::field {

[[nodiscard]] std::string field_part(const FieldResults& field, const report::Page& page);

// The chapter with its figures. gnuplot has its files in `scratch`. Adds notes for the user, such as a missing gnuplot.
[[nodiscard]] std::string field_page(const FieldResults& field, const std::filesystem::path& scratch,
                                     std::vector<std::string>& notes);

}  // namespace exactff::field
