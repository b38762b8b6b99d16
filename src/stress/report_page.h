// The stress report as one HTML page that loads nothing and has no scripts.
#pragma once

#include <string>
#include <vector>

#include "exactff/stress.h"
#include "page/figure.h"

namespace exactff::stress {

// `drawn` holds the figures of all families, in order.
[[nodiscard]] std::string report_page(const Report& report, const page::DrawnFigures& drawn);

}  // namespace exactff::stress
