// The report as one HTML page that fetches nothing and runs nothing.
#pragma once

#include <string>
#include <vector>

#include "exactff/study.h"
#include "study/figures.h"

namespace exactff::study {

// A figure with what gnuplot made of it; an empty picture stands for a figure that could not be drawn.
struct DrawnFigure {
  Figure figure;
  std::string svg;
};

struct Page {
  std::vector<DrawnFigure> figures;
  std::vector<LeftOut> left_out;  // the study's and the figures'
  std::string no_figures;         // why there are none, if so
};

[[nodiscard]] std::string report_page(const Study& study, const Page& page);

}  // namespace exactff::study
