#include "page/figure.h"

#include "files/parallel.h"
#include "page/gnuplot.h"

namespace exactff::page {

namespace {

constexpr const char* kNoGnuplot =
    "There are no figures because gnuplot was not found. Install it (Debian: gnuplot-nox) and run the command again. "
    "The tables are complete.";

}  // namespace

DrawnFigures draw_figures(std::vector<Figure> figures, const std::filesystem::path& scratch,
                          std::vector<std::string>& messages, const Hooks& hooks) {
  DrawnFigures drawn;
  std::size_t done = 0;
  for (Figure& figure : figures) {
    files::require_not_cancelled(hooks);
    const PlotResult plot = run_gnuplot(figure.script, scratch, hooks.cancelled);
    if (hooks.progress) hooks.progress({"figures", ++done, figures.size()});
    if (plot.outcome == PlotResult::Outcome::kNoProgram) {
      drawn.none = kNoGnuplot;
      messages.emplace_back(kNoGnuplot);
      return drawn;
    }
    if (plot.outcome == PlotResult::Outcome::kFailed) {
      messages.push_back("gnuplot could not draw '" + figure.title + "': " + plot.message);
      drawn.left_out.push_back({"figure: " + figure.title, "gnuplot could not draw it"});
      continue;
    }
    std::string svg = inline_svg(plot.svg, figure.id, figure.title);
    drawn.figures.push_back({std::move(figure), std::move(svg)});
  }
  return drawn;
}

}  // namespace exactff::page
