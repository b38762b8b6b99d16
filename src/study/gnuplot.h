// gnuplot, called as a program.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace exactff::study {

struct PlotResult {
  enum class Outcome { kDrawn, kNoProgram, kFailed } outcome = Outcome::kFailed;
  std::string svg;      // if drawn
  std::string message;  // if it failed: what gnuplot said
};

// Runs the script, which plots to standard output, with its files in `scratch`. A gnuplot that takes longer than a
// minute, or is still at work when `cancelled` says so, is ended and has failed.
[[nodiscard]] PlotResult run_gnuplot(std::string_view script, const std::filesystem::path& scratch,
                                     const std::function<bool()>& cancelled = {});

// gnuplot's SVG made fit to stand within an HTML page beside others: no prolog, every id begins with `prefix`,
// black becomes the page's text colour, the title is `title`, and nothing refers to anything outside.
[[nodiscard]] std::string inlined(std::string_view svg, std::string_view prefix, std::string_view title);

}  // namespace exactff::study
