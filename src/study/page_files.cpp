#include "study/page_files.h"

#include <fstream>

#include "study/gnuplot.h"

namespace exactff::study {

void require_not_cancelled(const Hooks& hooks) {
  if (hooks.cancelled && hooks.cancelled()) throw Cancelled();
}

void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& put) {
  std::ofstream out(file, std::ios::binary);
  put(out);
  out.close();
  if (out) return;
  throw InputError(Problem{file.string(), 0, "cannot be written",
                           "the disk may be full or read-only; nothing is left behind",
                           "make room, or name a folder elsewhere"});
}

namespace {

constexpr const char* kNoGnuplot =
    "There are no figures because gnuplot was not found; install it (Debian: gnuplot-nox) and run the command again. "
    "The tables are complete.";

}  // namespace

DrawnFigures draw_figures(std::vector<Figure> figures, const std::filesystem::path& scratch,
                          std::vector<std::string>& messages, const Hooks& hooks) {
  DrawnFigures drawn;
  std::size_t done = 0;
  for (Figure& figure : figures) {
    require_not_cancelled(hooks);
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
    std::string svg = inlined(plot.svg, figure.id, figure.title);
    drawn.figures.push_back({std::move(figure), std::move(svg)});
  }
  return drawn;
}

}  // namespace exactff::study
