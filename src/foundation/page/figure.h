// A figure of a report: a gnuplot script that contains its data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exactff/progress.h"

namespace exactff::page {

struct Figure {
  std::string id;  // unique in the page
  std::string title;
  std::string caption;  // HTML
  std::string script;   // plots one SVG to standard output
  bool map = false;     // a false-colour map over the grid
};

struct DrawnFigure {
  Figure figure;
  std::string svg;
};

struct DrawnFigures {
  std::vector<DrawnFigure> figures;
  std::vector<LeftOut> left_out;  // figures that gnuplot could not draw
  std::string none;               // why there are no figures; empty if there are
};

// Runs gnuplot, with its files in `scratch`. Adds notes for the user to `messages`.
[[nodiscard]] DrawnFigures draw_figures(std::vector<Figure> figures, const std::filesystem::path& scratch,
                                        std::vector<std::string>& messages, const Hooks& hooks);

}  // namespace exactff::page
