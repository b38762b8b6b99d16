// The figures of the report, as gnuplot scripts with their data inside.
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

// Only those the study has data for; what is missing is added to `left_out`.
[[nodiscard]] std::vector<Figure> figures(const Study& study, std::vector<LeftOut>& left_out);

// "ε_B = 0.0123, 16 jittered rays"; the parameters that tell it from the base are named.
[[nodiscard]] std::string label(const Study& study, std::size_t setting);

}  // namespace exactff::study
