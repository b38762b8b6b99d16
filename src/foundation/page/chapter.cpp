#include "page/chapter.h"

#include "files/parallel.h"
#include "jobs/kept_work.h"
#include "page/gnuplot.h"

namespace exactff::page {

// --- Figure ---

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

// --- Chapter ---

namespace {

template <class Words>
void fields(Words& words, Chapter& chapter) {
  words(chapter.name, chapter.title, chapter.paragraphs);
  words.list(chapter.tables, [&](NumberTable& table) {
    words(table.title, table.columns);
    words.list(table.rows, [&](std::vector<std::string>& row) { words(row); });
  });
  words.list(chapter.figures, [&](Figure& f) { words(f.id, f.title, f.caption, f.script, f.map); });
  for (auto* tables : {&chapter.values, &chapter.times}) {
    words.list(*tables, [&](CsvFile& table) { words(table.file, table.holds, table.csv); });
  }
  words.list(chapter.left_out, [&](LeftOut& item) { words(item.what, item.why); });
}

}  // namespace

std::string to_bytes(Chapter chapter) {
  jobs::WordWriter words;
  fields(words, chapter);
  return words.bytes();
}

std::optional<Chapter> chapter_of(std::string_view bytes) {
  jobs::WordReader words(bytes);
  Chapter chapter;
  fields(words, chapter);
  if (!words.complete()) return std::nullopt;
  return chapter;
}

}  // namespace exactff::page
