// Runs gnuplot as a program.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace exactff::page {

struct PlotResult {
  enum class Outcome { kDrawn, kNoProgram, kFailed } outcome = Outcome::kFailed;
  std::string svg;      // if drawn
  std::string message;  // gnuplot's messages if it failed
};

// Runs the script, which plots to standard output, with its files in `scratch`. gnuplot is ended, and counts as failed,
// if it takes longer than a minute or if `cancelled` returns true while it runs.
[[nodiscard]] PlotResult run_gnuplot(std::string_view script, const std::filesystem::path& scratch,
                                     const std::function<bool()>& cancelled = {});

// Prepares gnuplot's SVG for an HTML page with several figures: no prolog, every id begins with `prefix`, black becomes
// the page's text colour, the title is `title`, and nothing refers to anything outside.
[[nodiscard]] std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view title);

}  // namespace exactff::page
