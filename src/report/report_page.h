// The report as one HTML page that loads nothing and has no scripts.
#pragma once

#include <string>
#include <vector>

#include "page/figure.h"
#include "report/report.h"

namespace exactff::report {

// What belongs to each scene and each chapter of a report, in their order.
struct Page {
  page::DrawnFigures drawn;
  std::vector<LeftOut> left_out;  // from the study or chapter, and from its figures
};

struct Pages {
  std::vector<Page> scenes;
  std::vector<Page> chapters;
};

[[nodiscard]] std::string report_page(const StudyReport& report, const Pages& pages);

}  // namespace exactff::report
