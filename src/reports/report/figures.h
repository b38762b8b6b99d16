// The figures of the report, as gnuplot scripts that contain their data.
#pragma once

#include <string>
#include <vector>

#include "page/chapter.h"
#include "report/studies.h"

namespace exactff::report {

// Returns only the figures that the study has data for. The missing ones are added to `left_out`.
[[nodiscard]] std::vector<page::Figure> figures(const Study& study, std::vector<LeftOut>& left_out);

// Adds those that compare the methods and show where their errors are.
void add_method_figures(const Study& study, std::vector<page::Figure>& figures, std::vector<LeftOut>& left_out);

}  // namespace exactff::report
