// Draws the figures of a report, and writes complete files.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "exactff/study.h"
#include "study/figures.h"

namespace exactff::study {

// Throws Cancelled if the hooks request it.
void require_not_cancelled(const Hooks& hooks);

// Calls put(stream); throws InputError unless every byte was written.
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& put);

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

}  // namespace exactff::study
