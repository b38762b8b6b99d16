// The report as one HTML page that fetches nothing and runs nothing.
#pragma once

#include <string>
#include <vector>

#include "exactff/study.h"
#include "study/page_files.h"

namespace exactff::study {

struct Page {
  DrawnFigures drawn;
  std::vector<LeftOut> left_out;  // the study's and the figures' that it had no data for
};

[[nodiscard]] std::string report_page(const Study& study, const Page& page);

}  // namespace exactff::study
