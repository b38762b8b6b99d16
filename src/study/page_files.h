// Figures drawn for a report, and files written whole.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "exactff/study.h"
#include "study/figures.h"

namespace exactff::study {

// Throws Cancelled if the hooks say so.
void require_not_cancelled(const Hooks& hooks);

// Calls put(stream); throws InputError unless every byte was written.
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& put);

struct DrawnFigure {
  Figure figure;
  std::string svg;
};

struct DrawnFigures {
  std::vector<DrawnFigure> figures;
  std::vector<LeftOut> left_out;  // what gnuplot could not draw
  std::string none;               // why there are no figures, if so
};

// By gnuplot, with its files in `scratch`. Adds to `messages` what is worth telling.
[[nodiscard]] DrawnFigures draw_figures(std::vector<Figure> figures, const std::filesystem::path& scratch,
                                        std::vector<std::string>& messages, const Hooks& hooks);

}  // namespace exactff::study
