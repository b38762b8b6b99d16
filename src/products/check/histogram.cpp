// Pictures of errors, drawn by gnuplot.
#include <algorithm>
#include <cmath>
#include <limits>

#include "check/report.h"
#include "files/file.h"
#include "kernel/float_environment.h"
#include "page/gnuplot.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::check {
namespace {

double edge(long index, int bins_per_decade) {
  return std::pow(10.0, static_cast<double>(index) / static_cast<double>(bins_per_decade));
}

// The bin with edge(k - 1) < value <= edge(k).
long bin_of(double value, int bins_per_decade) {
  const double finite = std::min(value, std::numeric_limits<double>::max());
  auto k = static_cast<long>(std::ceil(std::log10(finite) * bins_per_decade));
  if (edge(k, bins_per_decade) < finite) ++k;  // the logarithm was rounded down onto an edge
  return k;
}

// The limits of single errors. Each is listed once, even if it applies to several sources.
std::vector<page::Mark> limits(const Report& report) {
  std::vector<page::Mark> marks;
  for (const Verdict& verdict : report.verdicts) {
    if (verdict.criterion != "max-abs" && !verdict.criterion.starts_with("quantile")) continue;
    const page::Mark mark{verdict.criterion + " " + text::shortest(verdict.limit), verdict.limit};
    const auto is_same = [&](const page::Mark& other) { return other.title == mark.title; };
    if (std::none_of(marks.begin(), marks.end(), is_same)) marks.push_back(mark);
  }
  return marks;
}

// A temporary folder, not one beside the output: the picture may go to a pipe.
files::WorkFolder scratch_folder() {
  try {
    return files::WorkFolder(std::filesystem::temp_directory_path() / "exactff-plot");
  } catch (const std::filesystem::filesystem_error& error) {
    text::refuse("cannot create a temporary folder: " + error.code().message(), "gnuplot needs one to draw",
                 "set TMPDIR to a writable folder, or remove --plot");
  }
}

}  // namespace

Histogram histogram(const Report& report, int bins_per_decade, std::size_t most_bins) {
  const kernel::StandardArithmetic arithmetic;
  Histogram result;
  const std::vector<double>& errors = report.magnitudes;
  const auto nonzero = std::upper_bound(errors.begin(), errors.end(), 0.0);
  result.exact = static_cast<std::size_t>(nonzero - errors.begin());
  if (nonzero == errors.end()) return result;
  const long last = bin_of(errors.back(), bins_per_decade);
  const long first = std::max(bin_of(*nonzero, bins_per_decade), last - static_cast<long>(most_bins) + 1);
  auto from = nonzero;
  for (long k = first; k <= last; ++k) {
    const double high = edge(k, bins_per_decade);
    const auto to = k == last ? errors.end() : std::upper_bound(from, errors.end(), high);
    result.bins.push_back({edge(k - 1, bins_per_decade), high, static_cast<std::size_t>(to - from)});
    from = to;
  }
  return result;
}

std::string histogram_script(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  constexpr int kBinsPerDecade = 4;
  constexpr std::size_t kMostBins = 120;
  const Histogram shown = histogram(report, kBinsPerDecade, kMostBins);
  std::vector<page::Bar> bars;
  for (const HistogramBin& bin : shown.bins) bars.push_back({bin.low, bin.high, static_cast<double>(bin.count)});
  const std::string exact =
      shown.exact > 0 ? " (not shown: " + text::counted(shown.exact, "row") + " without error)" : "";
  const std::string rows = "of " + text::counted(report.overall.rows, "row");  // short: the axis is not long
  return page::bar_plot({"absolute error" + exact, rows, true, false}, bars, limits(report));
}

// A step of a line for each row would be too many.
std::string shares_script(const Scoreboard& board) {
  const kernel::StandardArithmetic arithmetic;
  constexpr std::size_t kMostPoints = 400;
  std::vector<page::Series> lines;
  for (const Score& score : board.scores) {
    page::Series& line = lines.emplace_back();
    line.title = score.program;
    line.style = static_cast<int>(lines.size());
    line.drawn = page::Drawn::kLine;
    const std::vector<double>& errors = score.report.magnitudes;
    const auto all = static_cast<double>(score.report.truth_rows);
    const std::size_t step = errors.size() / kMostPoints + 1;
    for (std::size_t i = 0; i < errors.size(); i += step) {
      const std::size_t last = std::min(i + step, errors.size());
      line.points.emplace_back(errors[last - 1], static_cast<double>(last) / all);
    }
  }
  if (lines.empty()) return {};
  return page::line_plot({.x = "absolute error",
                          .y = "share of all cases",
                          .log_y = false,
                          .extra = {"set yrange [0:1]"},
                          .marks = limits(board.scores.front().report)},
                         lines);
}

Plot plot(const std::string& script, const std::function<bool()>& cancelled) {
  if (script.empty()) return {{}, "every error is 0, which a logarithmic axis cannot show"};
  const files::WorkFolder scratch = scratch_folder();
  const page::PlotResult result = page::run_gnuplot(script, scratch.path(), cancelled);
  if (result.outcome == page::PlotResult::Outcome::kDrawn) return {result.svg, {}};
  const bool missing = result.outcome == page::PlotResult::Outcome::kNoProgram;
  return {{}, missing ? "gnuplot was not found; install it" : "gnuplot failed: " + result.message};
}

}  // namespace exactff::check
