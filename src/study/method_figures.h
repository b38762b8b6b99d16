// Figures that compare the methods and show where their errors are.
#pragma once

#include <vector>

#include "study/figures.h"

namespace exactff::study {

void add_method_figures(const Study& study, std::vector<Figure>& figures, std::vector<LeftOut>& left_out);

}  // namespace exactff::study
