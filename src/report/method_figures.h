// Figures that compare the methods and show where their errors are.
#pragma once

#include <vector>

#include "report/figures.h"

namespace exactff::report {

void add_method_figures(const Study& study, std::vector<page::Figure>& figures, std::vector<LeftOut>& left_out);

}  // namespace exactff::report
