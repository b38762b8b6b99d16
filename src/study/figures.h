// The figures of the report, as gnuplot scripts that contain their data.
#pragma once

#include <string>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

struct Figure {
  std::string id;  // unique in the page
  std::string title;
  std::string caption;  // HTML
  std::string script;   // plots one SVG to standard output
  bool map = false;     // a false-colour map over the grid
};

// Returns only the figures that the study has data for. The missing ones are added to `left_out`.
[[nodiscard]] std::vector<Figure> figures(const Study& study, std::vector<LeftOut>& left_out);

// "ε_B = 0.0123, 16 jittered rays": names the parameters that differ from the base.
[[nodiscard]] std::string label(const Study& study, std::size_t setting);

}  // namespace exactff::study
