// The stress report as one HTML page that loads nothing and has no scripts.
#pragma once

#include <string>
#include <vector>

#include "exactff/stress.h"
#include "study/page_files.h"

namespace exactff::stress {

// `drawn` holds the figures of all families, in order.
[[nodiscard]] std::string report_page(const Report& report, const study::DrawnFigures& drawn);

}  // namespace exactff::stress
